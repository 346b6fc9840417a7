#include "orbweaver/loop/grid/time_map_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "support/best_pulse.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::time_map_fit_test {
namespace {

constexpr double tolerance = 1e-11;
constexpr int enough = 300;

// Six harmonics under a map, written without it.
Loop unmapped(const TimeMap& map, const Isotropy& isotropy = {}) {
  Loop loop = test::random_loop_in(Subspace(4, 6, isotropy), constant_loop(std::vector<double>(4, 0.0), 3.0, 6), 41);
  loop.time_map = map;
  return with_time_map(loop, {}, enough);
}

Isotropy of_pendulum() {
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  return {test::element_of(pendulum, "S", 1, 2), test::element_of(pendulum, "R")};
}

TEST(TimeMapFit, CountsHarmonics) {
  Loop loop = test::random_loop(3, 20, 42, 3.0, 0.5);
  loop.cosine(13, 1) = 1e-3;
  EXPECT_EQ(harmonics_above(loop, 9e-4), 13);
  EXPECT_EQ(harmonics_above(loop, 1e9), 0);
}

TEST(TimeMapFit, FindsThePulseThatALoopWasMadeUnder) {
  for (const int j : {-4, 3, 6}) {
    const double kappa = std::pow(2.0, 0.25 * j);
    const TimeMapFit fit = test::best_pulse(unmapped({kappa, {}}), tolerance);
    EXPECT_DOUBLE_EQ(fit.map.kappa, kappa);
    EXPECT_EQ(fit.harmonics, 6);
  }
}

TEST(TimeMapFit, SavesHarmonicsOfAsymmetricLoops) {
  const Loop even = unmapped({1.0, {0.6, 0.3}});
  const TimeMapFit fit = fit_general(even, {}, tolerance);
  ASSERT_FALSE(fit.map.coefficients.empty());
  EXPECT_LT(fit.harmonics, 0.4 * harmonics_above(even, tolerance));
  const Loop mapped = with_time_map(even, fit.map, fit.harmonics + 10);
  EXPECT_EQ(harmonics_above(mapped, tolerance), fit.harmonics);
  EXPECT_LT(mean_distance(mapped, even), 30.0 * tolerance);
}

// The map that a loop has already does not mislead the next.
TEST(TimeMapFit, GoesOnFromAnotherMap) {
  const Loop even = unmapped({1.0, {0.6, 0.3}});
  const int wanted = fit_general(even, {}, tolerance).harmonics;
  for (const TimeMap& map : {TimeMap{2.0, {}}, TimeMap{1.0, {-0.4, 0.4}}}) {
    const TimeMapFit fit = fit_general(with_time_map(even, map, enough), {}, tolerance);
    EXPECT_LE(fit.harmonics, 1.15 * wanted);
  }
}

/// tanh(sin(s - begun)/width): two jumps, whose singularities lie width pi/2 from real s.
Loop jumping(double width, double begun, int cutoff) {
  Loop loop = constant_loop(std::vector<double>{0.0}, 3.0, cutoff);
  const int nodes = FourierGrid::nodes_at_least(4 * cutoff);
  std::vector<double> values(static_cast<std::size_t>(nodes));
  for (int j = 0; j < nodes; ++j)
    values[static_cast<std::size_t>(j)] = std::tanh(std::sin(2.0 * std::numbers::pi * j / nodes - begun) / width);
  FourierGrid::of_size(nodes).analyze(cutoff, 1, values.data(), loop.modes.data());
  return loop;
}

TEST(TimeMapFit, DrawsScalesFarApartWhereverALoopBegins) {
  for (const double begun : {0.0, 0.3, 1.2}) {
    SCOPED_TRACE(begun);
    const Loop even = jumping(0.02, begun, 1200);
    const TimeMapFit fit = fit_scales(even, {}, tolerance);
    EXPECT_GT(harmonics_above(even, tolerance), 700);
    const int needed = harmonics_above(with_time_map(even, fit.map, 600), tolerance);
    EXPECT_LT(needed, 200);
    EXPECT_GT(fit.harmonics, 0.5 * needed) << "counted a hundred times higher, and extrapolated";
  }
}

// Jumps that begin anywhere: one pass needs 500 harmonics, and 190 where s may begin anywhere too. A loop that leaves
// half its harmonics out has tails that truncation has made: counted to the tolerance they mislead the next pass.
TEST(TimeMapFit, DrawsSharpJumpsApartInSomePasses) {
  constexpr int every = 4800;
  for (const double begun : {0.0, 0.3, 1.2}) {
    SCOPED_TRACE(begun);
    const Loop even = jumping(0.005, begun, every);
    const int own = harmonics_above(even, tolerance);
    EXPECT_GT(own, 2500);
    const auto needed_under = [&](const Loop& seen) {
      return harmonics_above(with_time_map(even, fit_scales(seen, {}, tolerance).map, 900), tolerance);
    };
    EXPECT_LT(needed_under(with_cutoff(even, own)), 150);
    EXPECT_LT(needed_under(with_cutoff(even, own / 2)), 700);
  }
}

TEST(TimeMapFit, IsInvariantUnderTheIsotropy) {
  const Isotropy group = of_pendulum();
  const Loop even = unmapped({4.0, {}}, group);
  const TimeMapFit fit = fit_general(even, group, tolerance);
  EXPECT_TRUE(is_invariant(fit.map, group));
  EXPECT_LT(fit.harmonics, 0.6 * harmonics_above(even, tolerance));
  // A loop without symmetries shows that invariance comes from the isotropy asked for.
  const Loop any = unmapped({1.0, {0.6, 0.3}});
  EXPECT_FALSE(is_invariant(fit_general(any, {}, tolerance).map, group));
  EXPECT_TRUE(is_invariant(fit_general(any, group, tolerance).map, group));
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  const Isotropy quarter{test::element_of(pendulum, "R", 1, 4)};
  EXPECT_TRUE(is_invariant(fit_general(any, quarter, tolerance).map, quarter));
  EXPECT_FALSE(is_invariant({2.0, {}}, quarter));
  EXPECT_TRUE(is_invariant({2.0, {}}, group));
}

TEST(TimeMapFit, DensityStaysPositive) {
  const TimeMap shrunk = with_least_density({1.0, {1.5, 0.0, 0.0, 0.6}}, 0.1);
  const std::vector<double> density = densities(shrunk, 4000);
  EXPECT_NEAR(*std::min_element(density.begin(), density.end()), 0.1, 1e-3);
  EXPECT_DOUBLE_EQ(shrunk.coefficients[0], 2.5 * shrunk.coefficients[3]);
  const TimeMap gentle{1.0, {0.1, 0.2}};
  EXPECT_EQ(with_least_density(gentle, 0.1), gentle);
  EXPECT_THROW(static_cast<void>(with_least_density({2.0, {}}, 0.1)), core::MisuseError);
  EXPECT_TRUE(fit_general(constant_loop(std::vector<double>{1.0}, 1.0, 3), {}, tolerance).map.is_identity());
  EXPECT_THROW(static_cast<void>(fit_general(unmapped({}), {}, tolerance, 0)), core::MisuseError);
}

// z = 1/(e^2 + sin^2(t/2)) has its poles at t = +-2i asinh e: a rate like z^(1/2), one over the distance from them,
// takes harmonics like log(1/e), even time like 1/e.
TEST(TimeMapFit, FollowsARateOfWideRange) {
  constexpr double e = 0.02;
  constexpr int harmonics = 1000;
  const FourierGrid& grid = FourierGrid::of_size(FourierGrid::nodes_at_least(4 * harmonics));
  std::vector<double> nodal;
  for (int j = 0; j < grid.nodes(); ++j)
    nodal.push_back(1.0 / (e * e + std::pow(std::sin(std::numbers::pi * j / grid.nodes()), 2)));
  Loop loop = constant_loop(std::vector<double>{0.0}, 3.0, harmonics);
  grid.analyze(harmonics, 1, nodal.data(), loop.modes.data());
  const auto rate = [](const Samples& samples) {
    std::vector<double> out = samples.states;
    for (double& v : out) v = std::sqrt(v);
    return out;
  };
  constexpr double part = 1e-10 / (e * e);
  const TimeMapFit fit = fit_to_rate(loop, rate, {}, part);
  EXPECT_GT(harmonics_above(loop, part), 400);
  EXPECT_LT(fit.harmonics, 60);
  const std::vector<double> density = densities(fit.map, 4096);
  EXPECT_GT(*std::min_element(density.begin(), density.end()), 0.0);
  EXPECT_LT(*std::min_element(density.begin(), density.end()), 0.1);
  const Loop mapped = with_time_map(loop, fit.map, fit.harmonics + 10);
  EXPECT_LT(mean_distance(mapped, loop), 30.0 * part);
  // From there it is found again.
  EXPECT_LT(fit_to_rate(mapped, rate, {}, part).harmonics, 60);
}

}  // namespace
}  // namespace orbweaver::loop::time_map_fit_test
