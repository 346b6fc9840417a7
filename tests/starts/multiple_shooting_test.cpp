// Multiple shooting from guesses of few digits, through close passages and around a cycle.
#include "orbweaver/starts/multiple_shooting.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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
          },
          tolerance};
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

struct Row {
  std::string name;
  double px, py;
  double period;
  double least;  ///< the distance of the closest passage is below
};

class MultipleShootingOfThreeBodies : public testing::TestWithParam<Row> {};

TEST_P(MultipleShootingOfThreeBodies, BringsAStateToItsOrbit) {
  const auto system = systems::make_system("three_bodies");
  const Integrator integrator = integrator_of(*system);
  const auto [name, px, py, time, least] = GetParam();
  const GuessCurve rough =
      curve_through(trajectory_nodes(*system, integrator.advance, {2, 0, 0, 0, px, py}, time, time / 240.0));
  ASSERT_GT(distance(rough.state(time), rough.state(0.0)), 1e-5);
  const std::vector<double> closest = rough.state(rough.fastest().time);
  ASSERT_LT(std::min({system->guard(0, closest), system->guard(1, closest), system->guard(2, closest)}), least);
  const ShotCurve shot = shot_through(*system, integrator, rough, time / 240.0);
  ASSERT_TRUE(shot.curve) << shot.missed;
  EXPECT_EQ(shot.curve->period, time) << "the energy is conserved: it is the period that is given";
  // By an integrator of more digits, once around: each piece is left open by that of the test.
  const std::vector<double> begin = shot.curve->state(0.0);
  EXPECT_LT(distance(certificate::integrate(*system, begin, time, 1e-14), begin), 1e3 * tolerance);
}

// Of four digits (Li and Liao 2017) and five (Suvakov and Dmitrasinovic 2013).
INSTANTIATE_TEST_SUITE_P(Rows, MultipleShootingOfThreeBodies,
                         testing::Values(Row{"IA2", -0.6138, -0.2510, period, 0.07},
                                         Row{"MothI", -0.92888, -0.79212, 14.8939, 0.09},
                                         Row{"ButterflyI", -0.61378, -0.25102, 6.2356, 0.013}),
                         [](const auto& row) { return row.param.name; });

// A state that leads back nowhere near is told as one, with what is left open.
TEST(MultipleShooting, FindsNoOrbitWhereThereIsNone) {
  const auto system = systems::make_system("three_bodies");
  const Integrator integrator = integrator_of(*system);
  const double time = 3.1;
  const GuessCurve rough =
      curve_through(trajectory_nodes(*system, integrator.advance, {2, 0, 0.3, 0.2, -0.31, -0.7}, time, time / 240.0));
  const ShotCurve shot = shot_through(*system, integrator, rough, time / 240.0);
  EXPECT_FALSE(shot.curve);
  EXPECT_GT(shot.missed, 1e-3);
}

TEST(MultipleShooting, FindsThePeriodOfACycle) {
  const auto system = systems::make_system("van_der_pol");
  const Integrator integrator = integrator_of(*system);
  const double guessed = 6.7;  // mu = 1: T = 6.6632868593 (Andersen and Geer 1982)
  const GuessCurve rough =
      curve_through(trajectory_nodes(*system, integrator.advance, {2.0, 0.0}, guessed, guessed / 240.0));
  const ShotCurve shot = shot_through(*system, integrator, rough, guessed / 240.0);
  ASSERT_TRUE(shot.curve);
  EXPECT_NEAR(shot.curve->period, 6.6632868593, 1e-9);
}

}  // namespace
}  // namespace orbweaver::starts::multiple_shooting_test
