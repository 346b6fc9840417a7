#include "orbweaver/starts/sweep.hpp"

#include <algorithm>
#include <ctime>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/starts/sampled_eigenvalues.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/pendulum_loops.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::starts::sweep_test {
namespace {

using testing::HasSubstr;
constexpr double pi = std::numbers::pi;

/// The sweeps of the paper (periods 1 to 12 in steps of 0.01), made once a process.
const SweepResult& paper_sweep(const std::vector<double>& point) {
  static std::map<std::vector<double>, SweepResult> swept;
  if (swept.count(point) == 0) swept[point] = sweep(*systems::make_system("double_pendulum"), point, {});
  return swept[point];
}

/// Angular frequencies squared of the small motions about an equilibrium with angles 0 or pi, from the Lagrangian: the
/// generalised eigenvalues of stiffness against mass; unstable directions are negative.
Eigen::Vector2d lagrangian_frequencies(const std::map<std::string, double>& p, const std::vector<double>& point) {
  const double up_1 = std::cos(point[0]);
  const double up_2 = std::cos(point[1]);
  const double coupling = p.at("m2") * p.at("l1") * p.at("l2") * up_1 * up_2;
  Eigen::Matrix2d mass;
  mass << (p.at("m1") + p.at("m2")) * p.at("l1") * p.at("l1"), coupling, coupling, p.at("m2") * p.at("l2") * p.at("l2");
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
  stiffness(0, 0) = (p.at("m1") + p.at("m2")) * p.at("g") * p.at("l1") * up_1;
  stiffness(1, 1) = p.at("m2") * p.at("g") * p.at("l2") * up_2;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(stiffness, mass).eigenvalues();
}

class PendulumModes : public testing::TestWithParam<test::PendulumMode> {};

TEST_P(PendulumModes, PeriodsToRounding) {
  const test::PendulumMode& wanted = GetParam();
  const SweepResult& result = paper_sweep(wanted.point);
  const auto mode = std::find_if(result.modes.begin(), result.modes.end(),
                                 [&](const NormalMode& m) { return std::abs(m.period - wanted.period()) < 0.1; });
  ASSERT_NE(mode, result.modes.end());
  EXPECT_NEAR(mode->period, wanted.period(), 1e-12 * wanted.period());
  EXPECT_NEAR(mode->grid_period, wanted.period(), 0.01);
  EXPECT_NEAR(std::remainder(mode->grid_period, 0.01), 0.0, 1e-12);
  EXPECT_LT(mode->residual, 1e-13);
  EXPECT_EQ(loop::to_text(mode->isotropy), "S@1/2 R@0");

  // |dz(s = 0)| = 1, at rest there: cosines of the angles in the mode's ratio, sines of the velocities that belong to
  // it.
  loop::Loop direction = loop::constant_loop(wanted.point, wanted.period(), 10);
  ASSERT_EQ(mode->direction.modes.size(), direction.modes.size());
  ASSERT_EQ(mode->grid_direction.modes.size(), direction.modes.size());
  const double scale = 1.0 / std::hypot(1.0, wanted.ratio);
  const loop::Loop expected = test::linear_loop(wanted, scale, 10);
  direction.modes = mode->direction.modes;
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(direction.cosine(1, i), expected.cosine(1, i), 1e-12) << i;
    EXPECT_NEAR(direction.sine(1, i), expected.sine(1, i), 1e-12) << i;
    direction.cosine(1, i) = direction.sine(1, i) = 0.0;
  }
  for (const double rest : direction.modes) EXPECT_EQ(rest, 0.0);
}

TEST_P(PendulumModes, EigenvalueDipsThere) {
  const SweepResult& result = paper_sweep(GetParam().point);
  ASSERT_EQ(result.table.size(), 1101u);
  const auto value_near = [&](double period) {
    const auto n = static_cast<std::size_t>(std::lround((period - 1.0) / 0.01));
    EXPECT_NEAR(result.table[n].period, period, 0.006);
    return result.table[n].eigenvalue;
  };
  const double period = GetParam().period();
  EXPECT_LT(value_near(period), 0.01 * value_near(period - 0.3));
  EXPECT_LT(value_near(period), 0.01 * value_near(period + 0.3));
  for (const SweepPoint& point : result.table) EXPECT_GT(point.eigenvalue, -1e-12) << point.period;
}

INSTANTIATE_TEST_SUITE_P(Sweep, PendulumModes, testing::ValuesIn(test::pendulum_modes()), [](const auto& tested) {
  std::string name = tested.param.name;
  std::erase(name, '-');
  return name;
});

struct Rejected {
  double period;
  std::string reason;
};

void expect_rejected(const SweepResult& result, const std::vector<Rejected>& wanted) {
  ASSERT_EQ(result.rejected.size(), wanted.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_NEAR(result.rejected[n].period, wanted[n].period, 1e-10);
    EXPECT_THAT(result.rejected[n].reason, HasSubstr(wanted[n].reason));
  }
}

TEST(Sweep, ModesOfEachEquilibrium) {
  const SweepResult& down = paper_sweep({0, 0, 0, 0});
  ASSERT_EQ(down.modes.size(), 2u);
  EXPECT_GT(down.modes[0].period, down.modes[1].period) << "longest period first";
  const double out = test::out_phase().period();
  expect_rejected(down, {{2 * out, "2 times around the oscillation with T = 3.40"},
                         {3 * out, "3 times around the oscillation with T = 3.40"}});
  const double saddle = test::down_up().period();
  for (const test::PendulumMode& mode : {test::down_up(), test::up_down()}) {
    const SweepResult& result = paper_sweep(mode.point);
    EXPECT_EQ(result.modes.size(), 1u) << mode.name;
    expect_rejected(result, {{2 * saddle, "2 times around the oscillation with T = 5.283"}});
    EXPECT_EQ(result.fixed_point, mode.point);
  }
  const auto points = find_fixed_points(*systems::make_system("double_pendulum"), {{0.0, pi}, {0.0, pi}});
  ASSERT_EQ(points.size(), 4u);
  const SweepResult& up = paper_sweep(points.back());
  EXPECT_TRUE(up.modes.empty());
  EXPECT_TRUE(up.rejected.empty());
  for (const SweepPoint& point : up.table) EXPECT_GT(point.eigenvalue, 1e-3) << point.period;
}

TEST(Sweep, OtherMassesAndLengths) {
  const std::vector<std::map<std::string, double>> choices = {
      {{"m1", 1.0}, {"m2", 3.0}, {"l1", 1.0}, {"l2", 0.5}, {"g", 1.0}},
      {{"m1", 2.5}, {"m2", 0.4}, {"l1", 0.8}, {"l2", 1.3}, {"g", 2.0}}};
  for (const auto& parameters : choices) {
    const auto system = systems::make_system("double_pendulum", parameters);
    const auto points = find_fixed_points(*system, {{0.0, pi}, {0.0, pi}});
    ASSERT_EQ(points.size(), 4u);
    for (const std::vector<double>& point : points) {
      std::vector<double> wanted;
      for (const double square : lagrangian_frequencies(parameters, point))
        if (square > 0.0) wanted.push_back(2.0 * pi / std::sqrt(square));
      std::sort(wanted.rbegin(), wanted.rend());
      const SweepResult result = sweep(*system, point, {.period_from = 0.7, .period_to = 9.0, .step = 0.02});
      ASSERT_EQ(result.modes.size(), wanted.size());
      for (std::size_t n = 0; n < wanted.size(); ++n) {
        ASSERT_GT(wanted[n], 0.72);
        ASSERT_LT(wanted[n], 8.98);
        EXPECT_NEAR(result.modes[n].period, wanted[n], 1e-12 * wanted[n]);
      }
    }
  }
}

// The slow mode (T = 7.464672...) lies 0.0147 below four times the fast one: with steps of 0.02 the two dips show as
// one.
TEST(Sweep, ADipBehindAMultipleIsFound) {
  const auto system = systems::make_system("double_pendulum", {{"m2", 3.0}, {"l2", 0.5}});
  const SweepResult result =
      sweep(*system, std::vector<double>(4, 0.0), {.period_from = 7.0, .period_to = 8.0, .step = 0.02});
  ASSERT_EQ(result.modes.size(), 1u);
  EXPECT_NEAR(result.modes[0].period, 7.46467226254, 1e-10);
  expect_rejected(result, {{4 * 1.86983807304, "4 times around the oscillation with T = 1.869838"}});
}

// A light or a heavy outer bob, a short or a long outer rod: both modes at [0, 0] in any range that holds them,
// whatever the step of the picture. Their periods are tested in linear_modes_test.cpp.
TEST(Sweep, NoModeIsLostToTheStep) {
  const std::vector<std::map<std::string, double>> cases = {{{"m2", 1e-3}}, {{"m2", 1e-6}}, {{"m2", 1e3}},
                                                            {{"m2", 1e6}},  {{"l2", 1e-3}}, {{"l2", 1e3}}};
  for (const auto& parameters : cases) {
    const auto system = systems::make_system("double_pendulum", parameters);
    const std::vector<double> origin(4, 0.0);
    const LinearModes linear = linear_modes(*system, origin);
    ASSERT_EQ(linear.oscillations.size(), 2u);
    const double slow = linear.oscillations[0].period;
    const double fast = linear.oscillations[1].period;
    for (const double step : {0.1237, 0.37}) {
      const SweepResult result =
          sweep(*system, origin, {.period_from = 0.9 * fast, .period_to = 1.1 * slow + 1.0, .step = step});
      ASSERT_EQ(result.modes.size(), 2u) << step;
      EXPECT_EQ(result.modes[0].period, slow);
      EXPECT_EQ(result.modes[1].period, fast);
      EXPECT_EQ(loop::to_text(result.modes[0].isotropy), "S@1/2 R@0");
    }
    const SweepResult automatic = sweep(*system, origin, automatic_range(linear));
    EXPECT_EQ(automatic.modes.size(), 2u);
    EXPECT_EQ(automatic.table.size(), 1001u);
  }
}

TEST(Sweep, WhatARangeExcludesIsKept) {
  const auto system = systems::make_system("double_pendulum");
  const SweepResult result = sweep(*system, std::vector<double>(4, 0.0), {.period_from = 3.0, .period_to = 4.0});
  ASSERT_EQ(result.modes.size(), 1u);
  EXPECT_NEAR(result.modes[0].period, test::out_phase().period(), 1e-14);
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_NEAR(result.left_out[0].period, test::in_phase().period(), 1e-14);
}

TEST(Sweep, AnAutomaticRangeHoldsAllPeriodsOfTheEquilibrium) {
  const auto system = systems::make_system("double_pendulum");
  const SweepOptions down = automatic_range(linear_modes(*system, std::vector<double>(4, 0.0)));
  EXPECT_LT(down.period_from, 0.9 * test::out_phase().period());
  EXPECT_GT(down.period_to, 1.1 * test::in_phase().period());
  // Nothing oscillates: the saddle's time scales, which are those of the modes below.
  const SweepOptions up = automatic_range(linear_modes(*system, std::vector<double>{pi, pi, 0, 0}));
  EXPECT_NEAR(up.period_from, down.period_from, 1e-12);
  EXPECT_NEAR(up.period_to, down.period_to, 1e-12);
  EXPECT_EQ(automatic_range({}).period_to, SweepOptions{}.period_to);
}

/// The smallest eigenvalue of the assembled Hessian of the constant loop.
double assembled_eigenvalue(const systems::System& system, const std::vector<double>& point, double period,
                            int cutoff) {
  const loop::Loop loop = loop::constant_loop(point, period, cutoff);
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian);
  const loss::Unknowns unknowns{loop::Subspace::unrestricted(loop.dimension, cutoff), {}};
  return spectrum::smallest_eigenpairs(loss::assemble_hessian(linearization, unknowns, loss::Curvature::gauss_newton),
                                       {.count = 1})
      .values.front();
}

// The eigenvalues of an assembled H are known to rounding of |H|: to 1e-12 relative where they are not much smaller.
TEST(Sweep, BlocksGiveTheEigenvaluesOfTheAssembledHessian) {
  double worst = 0.0;
  int compared = 0;
  for (const char* name : {"double_pendulum", "henon_heiles"}) {
    const auto system = systems::make_system(name);
    std::vector<std::vector<double>> points{{0, 0, 0, 0}};
    if (name[0] == 'd') points = {{0, 0, 0, 0}, {0, pi, 0, 0}, {pi, 0, 0, 0}, {pi, pi, 0, 0}};
    for (const std::vector<double>& point : points)
      for (const int cutoff : {1, 3, 10}) {
        const SweepOptions options{.period_from = 1.0, .period_to = 12.0, .step = 0.11, .cutoff = cutoff};
        for (const SweepPoint& sample : sweep(*system, point, options).table) {
          const double assembled = assembled_eigenvalue(*system, point, sample.period, cutoff);
          const double rate = 2 * pi * cutoff / sample.period;
          const double size = std::max(9.0, rate * rate);  // of H
          EXPECT_NEAR(sample.eigenvalue, assembled, 1e-14 * size) << name << " " << sample.period;
          if (assembled < 1e-3 * size) continue;
          worst = std::max(worst, std::abs(sample.eigenvalue / assembled - 1.0));
          ++compared;
        }
      }
  }
  RecordProperty("worst_relative_error", fmt::format("{:.3e}", worst));
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(compared, 500);
}

/// Of the processor.
double seconds_of(const std::function<void()>& body) {
  const std::clock_t began = std::clock();
  body();
  return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
}

TEST(Sweep, OfFourEquilibriaTakesATwentiethOfAssembledHessians) {
  const auto system = systems::make_system("double_pendulum");
  const auto points = find_fixed_points(*system, {{0.0, pi}, {0.0, pi}});
  double least = 1.0;
  for (int attempt = 0; attempt < 5; ++attempt)
    least = std::min(least, seconds_of([&] {
      for (const std::vector<double>& point : points) EXPECT_EQ(sweep(*system, point, {}).table.size(), 1101u);
    }));
  constexpr int sample = 110;  // periods, for a tenth of the assembled Hessians
  const double assembled = 10.0 * seconds_of([&] {
    for (const std::vector<double>& point : points)
      for (int n = 1; n <= sample; ++n) (void)assembled_eigenvalue(*system, point, 0.1 * n, SweepOptions{}.cutoff);
  });
  std::cout << fmt::format("four equilibria, 1101 periods each: {:.1f} ms, {:.0f} with assembled Hessians\n",
                           1e3 * least, 1e3 * assembled);
  EXPECT_LT(least, assembled / 20.0);
}

TEST(Sweep, HarmonicOscillatorWithItsMultiples) {
  const auto system = systems::make_system("harmonic_oscillator", {{"omega", 2.0}});
  const SweepResult result = sweep(*system, std::vector<double>{0.0, 0.0}, {});
  ASSERT_EQ(result.modes.size(), 1u);
  EXPECT_NEAR(result.modes[0].period, pi, 1e-14);
  EXPECT_EQ(loop::to_text(result.modes[0].isotropy), "S@1/2 R@0");
  expect_rejected(result, {{2 * pi, "2 times around"}, {3 * pi, "3 times around"}});
}

/// The local minima of a table below a bound.
std::vector<double> dips(const std::vector<SweepPoint>& table, double below) {
  std::vector<double> periods;
  for (std::size_t n = 1; n + 1 < table.size(); ++n)
    if (table[n].eigenvalue < below && table[n].eigenvalue < table[n - 1].eigenvalue &&
        table[n].eigenvalue <= table[n + 1].eigenvalue)
      periods.push_back(table[n].period);
  return periods;
}

// The paper's figure 5: twice around 3.40 is no loop of odd harmonics, three times around is one.
TEST(Sweep, OddHarmonicsLeaveOutWhatGoesAroundTwice) {
  const std::vector<double> down{0.0, 0.0, 0.0, 0.0};
  const auto pendulum = systems::make_system("double_pendulum");
  const auto all = sampled_eigenvalues(*pendulum, down, {}, Harmonics::all);
  const auto odd = sampled_eigenvalues(*pendulum, down, {}, Harmonics::odd);
  const std::vector<SweepPoint>& table = paper_sweep(down).table;
  ASSERT_EQ(all.size(), table.size());
  ASSERT_EQ(odd.size(), table.size());
  for (std::size_t n = 0; n < table.size(); ++n) {
    EXPECT_EQ(all[n].period, table[n].period);
    EXPECT_EQ(all[n].eigenvalue, table[n].eigenvalue);
    EXPECT_GE(odd[n].eigenvalue, all[n].eigenvalue);
  }
  using ::testing::DoubleNear;
  EXPECT_THAT(dips(all, 1e-5), testing::ElementsAre(DoubleNear(3.40, 1e-9), DoubleNear(6.80, 1e-9),
                                                    DoubleNear(8.21, 1e-9), DoubleNear(10.20, 1e-9)));
  EXPECT_THAT(dips(odd, 1e-5),
              testing::ElementsAre(DoubleNear(3.40, 1e-9), DoubleNear(8.21, 1e-9), DoubleNear(10.20, 1e-9)));
}

TEST(Sweep, AWholeRatioOfPeriodsIsSaid) {
  const test::Oscillators system({1.0, 16.0});
  const std::vector<double> origin(4, 0.0);
  const SweepResult result = sweep(system, origin, {.period_from = 5.0, .period_to = 7.0});
  ASSERT_EQ(result.modes.size(), 1u);
  EXPECT_NEAR(result.modes[0].period, 2 * pi, 1e-14);
  expect_rejected(result, {{2 * pi, "4 times around the oscillation with T = 1.57079632"},
                           {2 * pi, "a resonance: 4 times the period of the oscillation with T = 1.57079632"}});
  EXPECT_EQ(
      sweep(test::Oscillators({1.0, 16.0 + 1e-9}), origin, {.period_from = 5.0, .period_to = 7.0}).rejected.size(), 1u);
}

TEST(Sweep, AStrongResonanceIsHandedOutWithItsKernel) {
  const test::Oscillators system({1.0, 4.0});
  const SweepResult result = sweep(system, std::vector<double>(4, 0.0), {.period_from = 5.0, .period_to = 7.0});
  EXPECT_TRUE(result.modes.empty());
  expect_rejected(result, {{2 * pi, "2 times around the oscillation with T = 3.1415926"}});
  ASSERT_EQ(result.degenerate.size(), 1u);
  EXPECT_NEAR(result.degenerate[0].period, 2 * pi, 1e-14);
  EXPECT_EQ(result.degenerate[0].harmonics, (std::vector<int>{1, 2}));
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_NEAR(result.left_out[0].period, pi, 1e-14);
}

TEST(Sweep, ResonanceOfHenonHeilesIsHandedOutWithItsKernel) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<double> origin(4, 0.0);
  const SweepResult result = sweep(*system, origin, {});
  EXPECT_TRUE(result.modes.empty());
  EXPECT_TRUE(result.rejected.empty());
  ASSERT_EQ(result.degenerate.size(), 1u);
  const DegenerateMode& mode = result.degenerate.front();
  EXPECT_NEAR(mode.period, 2 * pi, 1e-13);
  EXPECT_NEAR(mode.grid_period, 2 * pi, 0.01);
  ASSERT_EQ(mode.kernel.cols(), 2);
  EXPECT_LT((mode.kernel.adjoint() * mode.kernel - Eigen::MatrixXcd::Identity(2, 2)).norm(), 1e-13);
  // Near the origin q'' = -q in both coordinates: p = dq/dt = i q.
  EXPECT_LT((mode.kernel.bottomRows(2) - std::complex<double>(0, 1) * mode.kernel.topRows(2)).norm(), 1e-12);
}

TEST(Sweep, RepeatsBitForBit) {
  const auto system = systems::make_system("double_pendulum");
  const SweepOptions options{.period_from = 3.0, .period_to = 4.0};
  const SweepResult first = sweep(*system, std::vector<double>(4, 0.0), options);
  const SweepResult second = sweep(*system, std::vector<double>(4, 0.0), options);
  ASSERT_EQ(first.table.size(), 101u);
  for (std::size_t n = 0; n < first.table.size(); ++n) EXPECT_EQ(first.table[n].eigenvalue, second.table[n].eigenvalue);
  ASSERT_EQ(first.modes.size(), 1u);
  EXPECT_EQ(first.modes[0].period, second.modes[0].period);
  EXPECT_EQ(first.modes[0].direction, second.modes[0].direction);
}

TEST(Sweep, Misuse) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> origin(4, 0.0);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.period_from = 2.0, .period_to = 2.0})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.period_from = 3.0, .period_to = 2.0})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.period_from = 0.0})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.step = 0.0})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.step = -0.1})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, origin, {.cutoff = 0})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(sweep(*system, std::vector<double>(3, 0.0), {})), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::sweep_test
