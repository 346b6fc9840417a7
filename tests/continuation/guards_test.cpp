// Orbits that come near a zero of a guard: limits of guards, and families that end in a collision.
#include "least_guard.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "branch_end.hpp"
#include "continuation/families.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation::guards_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr double mu = 0.01215058560962404;
constexpr int r2 = 1;

std::shared_ptr<const systems::System> earth_moon() {
  static const std::shared_ptr<const systems::System> system = systems::make_system("pcr3bp", {{"mu", mu}});
  return system;
}

/// The Lyapunov family of L2 (its linear mode: Szebehely 1967, ch. 5). It grows until it meets the smaller body.
Start second_point() {
  double x = 1.15;
  for (int n = 0; n < 50; ++n) {  // Newton's method for the force on the axis
    const double a = x + mu;
    const double b = x - 1.0 + mu;
    x -= (x - (1.0 - mu) / (a * a) - mu / (b * b)) / (1.0 + 2.0 * (1.0 - mu) / (a * a * a) + 2.0 * mu / (b * b * b));
  }
  const double c = (1.0 - mu) / std::pow(x + mu, 3) + mu / std::pow(x - 1.0 + mu, 3);
  const double omega = std::sqrt(0.5 * (2.0 - c + std::sqrt(9.0 * c * c - 8.0 * c)));
  const double ratio = (omega * omega + 1.0 + 2.0 * c) / (2.0 * omega);
  Start start;
  start.base = loop::constant_loop(std::vector<double>{x, 0.0, 0.0, 0.0}, 2.0 * std::numbers::pi / omega, 10);
  loop::Loop mode = start.base;
  mode.cosine(1, 0) = 1.0;
  mode.sine(1, 1) = -ratio;
  mode.sine(1, 2) = -omega;
  mode.cosine(1, 3) = -ratio * omega;
  start.isotropy = loop::find_isotropy(earth_moon()->structure(), mode, 1e-9);
  for (std::size_t i = 0; i < 4; ++i) mode.modes[i] = 0.0;
  start.direction.modes = mode.modes;
  return start;
}

Options options_with(const std::string& guard, double limit) {
  Options options;
  options.start_amplitude = 0.01;
  options.guard_limits[guard] = limit;
  return options;
}

test::Trace second_family(const Options& options) { return test::trace_of(earth_moon(), second_point(), options); }

/// A loop on the x-axis whose distance from the smaller body is `mean` + `wave` cos(s - `phase`).
loop::Loop on_the_axis(double mean, double wave, double phase) {
  loop::Loop out = loop::constant_loop(std::vector<double>{1.0 - mu + mean, 0.0, 0.0, 0.0}, 3.0, 10);
  out.cosine(1, 0) = wave * std::cos(phase);
  out.sine(1, 0) = wave * std::sin(phase);
  return out;
}

TEST(LeastGuard, LiesBetweenNodes) {
  for (const double phase : {0.0, 0.1, 1.0, 3.1, -2.0}) {
    loop::Loop loop = on_the_axis(0.3, 0.2, phase);
    EXPECT_NEAR(least_guard(*earth_moon(), r2, loop), 0.1, 1e-15) << phase;
    loop.time_map.kappa = 1.5;
    EXPECT_NEAR(least_guard(*earth_moon(), r2, loop), 0.1, 1e-15) << phase;
  }
  EXPECT_NEAR(least_guard(*earth_moon(), 0, on_the_axis(0.3, 0.2, 0.7)), 1.1, 1e-15);
}

TEST(LeastGuard, IsTheSmallestOfMinimaThatHardlyDiffer) {
  for (const double tilt : {1e-9, -1e-9}) {
    loop::Loop loop = on_the_axis(0.3, tilt, 0.3);
    loop.cosine(2, 0) = 0.2 * std::cos(0.6);  // minima at s = 0.3 +- pi/2, of which sin s makes one the smaller
    loop.sine(2, 0) = 0.2 * std::sin(0.6);
    loop.sine(1, 0) += tilt;
    EXPECT_NEAR(least_guard(*earth_moon(), r2, loop), 0.1 - std::abs(tilt) * std::cos(0.3), 1e-15);
  }
}

TEST(LeastGuard, MisuseThrows) {
  EXPECT_THROW((void)least_guard(*earth_moon(), 2, on_the_axis(0.3, 0.2, 0.0)), core::MisuseError);
  EXPECT_THROW((void)least_guard(*test::pendulum(), 0, test::start_of(test::in_phase()).base), core::MisuseError);
  EXPECT_THROW(Branch(earth_moon(), second_point(), options_with("r3", 0.1)), core::MisuseError);
}

TEST(GuardLimits, AreHitExactly) {
  const std::vector<std::pair<corrector::Method, double>> cases{{corrector::Method::automatic, 0.1},
                                                                {corrector::Method::automatic, 0.0045},
                                                                {corrector::Method::newton_krylov, 0.1},
                                                                {corrector::Method::newton_krylov, 0.04}};
  for (const auto& [method, limit] : cases) {
    SCOPED_TRACE(std::string(name_of(method)) + " at " + std::to_string(limit));
    Options options = options_with("r2", limit);
    options.corrector.method = method;
    const test::Trace trace = second_family(options);
    ASSERT_EQ(trace.ending.reason, EndReason::guard_limit) << trace.ending.text();
    EXPECT_FALSE(trace.ending.failed());
    EXPECT_THAT(trace.ending.text(), StartsWith("guard limit (r2 = 0."));
    EXPECT_NEAR(least_guard(*earth_moon(), r2, trace.last().loop), limit, 1e-12);
    for (std::size_t n = 0; n + 1 < trace.orbits.size(); ++n)
      EXPECT_GT(least_guard(*earth_moon(), r2, trace.orbits[n].loop), limit);
  }
  EXPECT_EQ(second_family(options_with("r2", 0.0045)).ending.text(), "guard limit (r2 = 0.0045)");
}

TEST(GuardLimits, EndAtOneOrbitWhateverTheSteps) {
  const Orbit expected = second_family(options_with("r2", 0.0045)).last();
  for (const double start : {0.0017, 0.0175})
    for (const double longest : {1.0, 0.1}) {
      SCOPED_TRACE(start);
      Options options = options_with("r2", 0.0045);
      options.start_amplitude = start;
      options.largest_step = longest;
      const test::Trace trace = second_family(options);
      ASSERT_EQ(trace.ending.reason, EndReason::guard_limit) << trace.ending.text();
      EXPECT_NEAR(trace.last().loop.period, expected.loop.period, 1e-9);
      EXPECT_NEAR(trace.last().energy, expected.energy, 1e-10);
    }
}

// Where one step passes two limits the branch ends at what comes first.
TEST(GuardLimits, TheFirstOfTwoLimitsIsHit) {
  const Orbit at_guard = second_family(options_with("r2", 0.05)).last();
  for (const double beside : {-1e-5, 1e-5}) {
    const EndReason first = beside < 0.0 ? EndReason::energy_limit : EndReason::guard_limit;
    Options options = options_with("r2", 0.05);
    options.energy_to = at_guard.energy + beside;
    const test::Trace by_energy = second_family(options);
    EXPECT_EQ(by_energy.ending.reason, first) << by_energy.ending.text();
    EXPECT_NEAR(by_energy.last().energy, at_guard.energy + std::min(beside, 0.0), 1e-10);
    options = options_with("r2", 0.05);
    options.period_limit = at_guard.loop.period + beside;
    const test::Trace by_period = second_family(options);
    EXPECT_EQ(by_period.ending.reason, beside < 0.0 ? EndReason::period_limit : EndReason::guard_limit)
        << by_period.ending.text();
    EXPECT_NEAR(by_period.last().loop.period, at_guard.loop.period + std::min(beside, 0.0), 1e-9);
  }
  Options both = options_with("r2", 0.05);
  both.guard_limits["r1"] = 1.0;
  const test::Trace trace = second_family(both);
  ASSERT_EQ(trace.ending.reason, EndReason::guard_limit);
  EXPECT_GE(least_guard(*earth_moon(), 0, trace.last().loop), 1.0 - 1e-12);
  EXPECT_GE(least_guard(*earth_moon(), r2, trace.last().loop), 0.05 - 1e-12);
}

// Such a passage lasts 1e-5 of the period: maps that do not follow the guards take 319 harmonics.
TEST(GuardLimits, NearOnesTakeFewHarmonics) {
  const test::Trace trace = second_family(options_with("r2", 2e-4));
  ASSERT_EQ(trace.ending.reason, EndReason::guard_limit) << trace.ending.text();
  EXPECT_LT(trace.last().loop.cutoff, 250);
  EXPECT_LT(trace.orbits.size(), 80u);
}

TEST(GuardLimits, StartsBeyondThemGiveNoOrbit) {
  const test::Trace trace = second_family(options_with("r2", 0.5));
  EXPECT_TRUE(trace.orbits.empty());
  EXPECT_THAT(trace.ending.text(), StartsWith("guard limit (left out: begins at r2 = 0.16"));
  EXPECT_FALSE(trace.ending.failed());
}

TEST(Collisions, AreNamed) {
  Options options{.cutoff_to = 100};
  options.start_amplitude = 0.01;
  const test::Trace trace = second_family(options);
  EXPECT_EQ(trace.ending.reason, EndReason::collision) << trace.ending.text();
  EXPECT_FALSE(trace.ending.failed());
  EXPECT_THAT(trace.ending.text(), StartsWith("collision with the smaller body (r2 = 0.0"));
  EXPECT_THAT(trace.ending.text(), HasSubstr("; the next orbit needs more than K = 100)"));
  EXPECT_LT(least_guard(*earth_moon(), r2, trace.last().loop), 0.02);
  options.cutoff_to = 31;  // far from the body
  EXPECT_EQ(second_family(options).ending.reason, EndReason::cutoff_limit);
}

TEST(Collisions, EndFamiliesWhereRoundingDoes) {
  Options options;
  options.start_amplitude = 0.01;
  const test::Trace trace = second_family(options);
  EXPECT_EQ(trace.ending.reason, EndReason::collision) << trace.ending.text();
  EXPECT_THAT(trace.ending.text(), HasSubstr("; rounding leaves "));
  EXPECT_LT(least_guard(*earth_moon(), r2, trace.last().loop), 1e-4);
  EXPECT_LT(trace.last().loop.cutoff, 300);
  EXPECT_LT(trace.last().loss_rms, 1e-6);
}

/// A branch that came to a hundredth of a guard's first value.
Frontier near_a_body() {
  Frontier frontier;
  frontier.orbit.loop = loop::constant_loop(std::vector<double>{1.0, 0.0, 0.0, 0.0}, 7.0, 400);
  frontier.orbit.energy = frontier.earlier_level = -1.4;
  frontier.first = loop::constant_loop(std::vector<double>{1.0, 0.0, 0.0, 0.0}, 6.0, 10);
  frontier.first_level = -1.5;
  frontier.guards = {{1.0, 1.0, {1.0, 1.0, 1.0, 1.0, 1.0}}, {0.01, 1.0, {0.02, 0.018, 0.016, 0.014, 0.012}}};
  return frontier;
}

TEST(Collisions, AreToldFromOtherEnds) {
  const auto end_of = [](const Frontier& frontier) {
    return end_between(frontier, *earth_moon(), EndReason::failure, "why").reason;
  };
  EXPECT_EQ(end_of(near_a_body()), EndReason::collision);
  EXPECT_EQ(end_between(near_a_body(), *earth_moon(), EndReason::failure, "why").text(),
            "collision with the smaller body (r2 = 0.01 at T = 7; why)");
  Frontier settled = near_a_body();
  settled.guards[r2].earlier = {0.0104, 0.0103, 0.0102, 0.0101, 0.01};
  EXPECT_EQ(end_of(settled), EndReason::failure);
  Frontier far = near_a_body();
  far.guards[r2].fallen_from = 0.05;
  EXPECT_EQ(end_of(far), EndReason::failure);
  Frontier few = near_a_body();
  few.guards[r2].earlier.pop_back();
  EXPECT_EQ(end_of(few), EndReason::failure);
  Frontier coarse = near_a_body();
  coarse.orbit.loop.cutoff = 20;
  EXPECT_EQ(end_of(coarse), EndReason::failure);
  Frontier diverging = near_a_body();
  diverging.orbit.loop.period = 20.0;
  EXPECT_EQ(end_of(diverging), EndReason::period_divergence);
}

}  // namespace
}  // namespace orbweaver::continuation::guards_test
