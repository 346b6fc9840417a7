// A published orbit of three equal bodies that pass at a hundredth of their distance: its guess is resolved, and
// brought nearer where its digits are few.
#include "orbweaver/starts/multiple_shooting.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/starts/loop_guess.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::starts::multiple_shooting_test {
namespace {

constexpr double period = 6.2346748391;
constexpr double longest = period / 240.0;
constexpr double tolerance = 1e-12;

Integrator integrator_of(const systems::System& system) {
  return {[&system](const std::vector<double>& state, double time) {
            return certificate::integrate(system, state, time, tolerance);
          },
          [&system](const std::vector<double>& state, double time) {
            return certificate::transitions(system, {state}, time, tolerance).front();
          }};
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) square += std::pow(a[i] - b[i], 2);
  return std::sqrt(square);
}

TEST(MultipleShooting, AGuessIsResolvedWhereItsMotionIsFast) {
  const auto system = systems::make_system("three_bodies");
  const Integrator integrator = integrator_of(*system);
  const GuessCurve curve = curve_through(
      trajectory_nodes(*system, integrator.advance, {2, 0, 0, 0, -0.6137868410, -0.2510131340}, period, longest));
  const loop::Loop loop = loop_through(system->structure(), curve);
  EXPECT_EQ(loop.period, period);
  ASSERT_FALSE(loop.time_map.is_identity()) << "times that are spaced evenly do not resolve it";
  const double fastest = curve.fastest().time;
  for (const double time : {0.1, 0.3 * period, fastest, fastest + 0.5 / curve.fastest().rate}) {
    const std::vector<double> exact = integrator.advance(curve.state(0.0), time);
    EXPECT_LT(distance(curve.state(time), exact), 1e-6) << time;
    EXPECT_LT(distance(loop::state_at(loop, time), exact), 1e-5) << time;
  }
}

TEST(MultipleShooting, BringsAStateOfFourDigitsToItsOrbit) {
  const auto system = systems::make_system("three_bodies");
  const Integrator integrator = integrator_of(*system);
  const GuessCurve rough =
      curve_through(trajectory_nodes(*system, integrator.advance, {2, 0, 0, 0, -0.6138, -0.2510}, period, longest));
  const double gap = distance(rough.state(period), rough.state(0.0));
  ASSERT_GT(gap, 1e-5);
  const ShotCurve shot = shot_through(*system, integrator, rough, longest);
  EXPECT_LT(shot.missed, 1e-3 * gap);
  EXPECT_EQ(shot.curve.period, period) << "the energy is conserved: it is the period that is given";
  EXPECT_LT(distance(integrator.advance(shot.curve.state(0.0), period), shot.curve.state(0.0)), 1e-2 * gap);
}

TEST(MultipleShooting, FindsThePeriodOfACycle) {
  const auto system = systems::make_system("van_der_pol");
  const Integrator integrator = integrator_of(*system);
  const double guessed = 6.7;  // mu = 1: T = 6.6632868593 (Andersen and Geer 1982)
  const GuessCurve rough =
      curve_through(trajectory_nodes(*system, integrator.advance, {2.0, 0.0}, guessed, guessed / 240.0));
  const ShotCurve shot = shot_through(*system, integrator, rough, guessed / 240.0);
  EXPECT_NEAR(shot.curve.period, 6.6632868593, 1e-8);
}

}  // namespace
}  // namespace orbweaver::starts::multiple_shooting_test
