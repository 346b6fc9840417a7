#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "corrector/fixture.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::corrector::threshold_test {
namespace {

double threshold_of(const systems::System& system, const loop::Loop& loop, double tolerance,
                    loss::Linearization::Order order = loss::Linearization::Order::jacobian) {
  return acceptance_threshold(loop, loss::Linearization(system, loop, order), tolerance);
}

TEST(AcceptanceThreshold, ScalesWithTheSpeedUpToOne) {
  const auto system = systems::make_system("double_pendulum");
  for (const double amplitude : {1e-8, 1e-3, 0.3}) {
    const loop::Loop loop = test::linear_loop(test::in_phase(), amplitude, 8);
    // Angles and velocities are sinusoids of amplitudes w a (1, sqrt 2) and w^2 a (1, sqrt 2).
    const double w = test::in_phase().frequency;
    const double speed = amplitude * w * std::sqrt(1.5 * (1.0 + w * w));
    EXPECT_NEAR(threshold_of(*system, loop, 1e-10), 1e-10 * speed, 1e-13 * 1e-10 * speed) << amplitude;
  }
  const loop::Loop fast = test::linear_loop(test::in_phase(), 3.0, 8);
  ASSERT_GT(loop::rms_speed(fast), 1.0);
  EXPECT_EQ(threshold_of(*system, fast, 1e-10), 1e-10);
  EXPECT_EQ(threshold_of(*system, fast, 1e-7), 1e-7);
}

// Around (0, pi) the state carries rounding of eps pi: the residual cannot go below that times |df/dz|.
TEST(AcceptanceThreshold, NeverBelowTheRoundingOfTheResidual) {
  const auto system = systems::make_system("double_pendulum");
  const double point[4] = {0.0, std::numbers::pi, 0.0, 0.0};
  double f[4];
  double a[16];
  system->field_jacobian(1, point, f, a);
  double square = 0.0;
  for (const double entry : a) square += entry * entry;
  const double floor = 4.0 * std::numeric_limits<double>::epsilon() * std::numbers::pi * std::sqrt(square);
  const loop::Loop tiny = test::linear_loop(test::down_up(), 1e-8, 8);
  ASSERT_GT(floor, 1e-10 * loop::rms_speed(tiny));
  EXPECT_NEAR(threshold_of(*system, tiny, 1e-10), floor, 1e-6 * floor);
  EXPECT_EQ(threshold_of(*system, tiny, 1e-10, loss::Linearization::Order::residual), 1e-10 * loop::rms_speed(tiny));
  const loop::Loop small = test::linear_loop(test::down_up(), 1e-2, 8);
  EXPECT_EQ(threshold_of(*system, small, 1e-10), 1e-10 * loop::rms_speed(small));
}

// There a loop of amplitude 1e-13 has a speed that is known to a twentieth.
TEST(AcceptanceThreshold, ALoopWhoseSpeedIsRoundingIsNoOrbit) {
  for (const Method method : {Method::newton_krylov, Method::nls}) {
    const test::Problem lost(test::down_up(), 1e-13, 10);
    const Result result = lost.correct(lost.guess, {.method = method});
    EXPECT_EQ(result.outcome, Outcome::lost_in_rounding) << name_of(method) << ": " << name_of(result.outcome);
    EXPECT_THAT(result.detail, testing::HasSubstr("of the speed open"));
    const test::Problem known(test::down_up(), 1e-12, 10);
    const Result kept = known.correct(known.guess, {.method = method});
    ASSERT_TRUE(kept.converged()) << name_of(method) << ": " << kept.detail;
    EXPECT_GT(kept.tolerance_met, 1e-3) << "far from 1e-10";
    EXPECT_LT(kept.tolerance_met, largest_unknown);
    const test::Problem at_zero(test::in_phase(), 1e-13, 10);
    const Result all = at_zero.correct(at_zero.guess, {.method = method});
    ASSERT_TRUE(all.converged()) << name_of(method) << ": " << all.detail;
    EXPECT_EQ(all.tolerance_met, 0.0);
  }
}

struct Tiny {
  test::PendulumMode mode;
  double amplitude;
  double period_error;  ///< allowed, relative
  double shape_error;   ///< allowed, relative to the amplitude
};

class TinyAmplitude : public testing::TestWithParam<Tiny> {};

// The period moves with the square of the amplitude; around a point away from 0 rounding eps pi / amplitude comes on
// top.
TEST_P(TinyAmplitude, ConvergesToTheNormalMode) {
  const auto& [mode, amplitude, period_error, shape_error] = GetParam();
  const test::Problem problem(mode, amplitude, 10);
  for (const Method method : {Method::newton_krylov, Method::brgn, Method::nls, Method::ntr}) {
    loop::Loop guess = problem.guess;
    guess.cosine(1, 1) *= 1.01;
    guess.period *= 1.001;
    const Result result = problem.correct(guess, {.method = method});
    ASSERT_TRUE(result.converged()) << name_of(method) << ": " << result.detail;
    EXPECT_NEAR(result.loop.period, mode.period(), period_error * mode.period()) << name_of(method);
    EXPECT_NEAR(result.loop.cosine(1, 1) / result.loop.cosine(1, 0), mode.ratio, shape_error) << name_of(method);
    EXPECT_NEAR(result.loop.cosine(1, 0), amplitude, 0.02 * amplitude);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Corrector, TinyAmplitude,
    testing::Values(Tiny{test::in_phase(), 1e-4, 1e-8, 1e-7}, Tiny{test::in_phase(), 1e-8, 1e-13, 1e-12},
                    Tiny{test::out_phase(), 1e-4, 1e-7, 1e-7}, Tiny{test::out_phase(), 1e-8, 1e-13, 1e-12},
                    Tiny{test::down_up(), 1e-4, 1e-8, 1e-7}, Tiny{test::down_up(), 1e-8, 2e-6, 1e-5},
                    Tiny{test::up_down(), 1e-4, 1e-7, 1e-7}, Tiny{test::up_down(), 1e-8, 2e-6, 1e-5}));

}  // namespace
}  // namespace orbweaver::corrector::threshold_test
