// Kernels of dimension 4: two pairs of multipliers in one sector at once, and two oscillations of one period.
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/ranges.h>

#include "bifurcation/crossings.hpp"
#include "bifurcation/plane_family.hpp"
#include "hard/hard_case.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace kernels_test {
namespace {

using namespace orbweaver;

// H = I + I |x|^2/2: along the circle of action I both pairs of x turn by 2 pi I, so that at I = 1/q their null vectors
// are x = cos t/q and sin t/q in either pair: four, of harmonic 1 on the circle gone around q times.
TEST(Kernels, OfTwoPairsAtOnce) {
  const test::PlaneFamily system({Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Identity(), {}, {}});
  const std::string name = "two pairs pass exp(2 pi i/q) at once, q = 3, 4, 5, 7";
  test::HardCase row(name, "kernels of dimension 4");
  std::vector<int> dimensions;
  double singular_values = 0.0;
  double period = 0.0;
  double other = 0.0;
  for (const int q : {3, 4, 5, 7}) {
    const double action = 1.0 / q;
    continuation::CurvePoint point;
    point.loop = system.circle(action);
    point.tangent.modes.assign(point.loop.modes.size(), 0.0);
    point.tangent.scalars = {0.0};
    for (std::size_t n = 0; n < point.loop.modes.size(); ++n)
      point.tangent.modes[n] = point.loop.modes[n] / std::sqrt(4.0 * action);
    const bifurcation::Kernel kernel = bifurcation::kernel_of(system, point, {}, {q, 1}, 4);
    dimensions.push_back(kernel.dimension());
    singular_values = test::worse(singular_values, kernel.largest());
    period = test::worse(period, std::abs(kernel.base.period / (2.0 * std::numbers::pi * q) - 1.0));
    for (const loop::Tangent& v : kernel.vectors) {
      const loop::Loop moved = loop::perturbation(kernel.base, v);
      for (int k = 0; k <= moved.cutoff; ++k)
        for (int i = 0; i < 6; ++i)
          if (k != 1 || i < 2)
            other =
                test::worse(other, std::max(std::abs(moved.cosine(k, i)), k > 0 ? std::abs(moved.sine(k, i)) : 0.0));
    }
  }
  row.is(dimensions == std::vector<int>(4, 4), "4, 4, 4, 4", fmt::format("{}", fmt::join(dimensions, ", ")));
  test::HardCase(name, "singular values 0").within(singular_values, 1e-10);
  test::HardCase(name, "T q times around, relative").within(period, 1e-14);
  test::HardCase(name, "vectors of harmonic 1 in x: all else 0").within(other, 1e-10);
}

// Orbits near two oscillations of one period, energies of one sign, are zeros of a vector field on CP^1, whose indices
// sign(2 - k) add up to 2 (Weinstein 1973, Moser 1976); those of Henon and Heiles are 3, 3 and 2 with their images
// (Churchill, Pecelli and Rod 1979, doi:10.1007/BFb0021739).
TEST(Kernels, OfTwoOscillationsOfOnePeriod) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<double> origin(4, 0.0);
  test::HardCase row("Henon-Heiles at the origin, kernel of dimension 4", "8 families: 3 + 3 + 2 images");
  const bifurcation::SmallOscillations all = bifurcation::small_oscillations(
      *system, starts::sweep(*system, origin, {.period_from = 6.0, .period_to = 6.5, .step = 0.5}), 10);
  ASSERT_EQ(all.kernels.size(), 1U);
  std::vector<int> images;
  for (const bifurcation::KernelFamily& family : all.kernels[0].families) images.push_back(family.images);
  row.is(images == std::vector<int>{3, 3, 2}, "3, 3, 2", fmt::format("{}", fmt::join(images, ", ")));
  for (const double energy : {0.01, 0.05, 0.1}) {
    int sum = 0;
    for (std::size_t n = 0; n < all.families.size(); ++n) {
      const starts::NormalMode& mode = all.families[n].mode;
      continuation::Options options;
      options.energy_to = energy;
      options.start_amplitude = 1e-3;
      const test::Trace trace = test::trace_of(
          system, {loop::constant_loop(origin, mode.period, 10), mode.direction, mode.isotropy}, options);
      ASSERT_EQ(trace.ending.reason, continuation::EndReason::energy_limit) << trace.ending.text();
      const spectrum::Stability stability = spectrum::floquet(*system, trace.last().loop, mode.isotropy);
      const double off = 2.0 - stability.full.at(0).real();
      EXPECT_GT(std::abs(off), stability.full_error.at(0));
      sum += (off > 0.0 ? 1 : -1) * images.at(n);
    }
    test::HardCase(fmt::format("Henon-Heiles at E = {}", energy), "indices sign(2 - k) of the 8 add up to 2")
        .is(sum == 2, "2", fmt::format("{}", sum));
  }
}

}  // namespace
}  // namespace kernels_test
