#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "corrector/oscillator.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {
namespace {

using testing::HasSubstr;

/// A start from an orbit of a traced family towards smaller amplitudes.
Start downwards(const test::Trace& family, double period) {
  const corrector::Result upper = test::orbit_at(family, period);
  const corrector::Result lower = test::orbit_at(family, period - 0.02);
  EXPECT_TRUE(upper.converged() && lower.converged());
  Start start{upper.loop, {}, test::pendulum_isotropy(*test::pendulum())};
  start.direction.modes = loop::with_cutoff(lower.loop, upper.loop.cutoff).modes;
  for (std::size_t n = 0; n < upper.loop.modes.size(); ++n) start.direction.modes[n] -= upper.loop.modes[n];
  return start;
}

TEST(Ends, EnergyLimitIsHitExactly) {
  for (const double limit : {-2.9, -1.0, 0.672600806149962748}) {
    const test::Trace up = test::trace_of(test::in_phase(), {.period_limit = 12.0, .energy_to = limit});
    EXPECT_EQ(up.ending.reason, EndReason::energy_limit) << up.ending.text();
    EXPECT_NEAR(up.last().energy, limit, 1e-12);
    for (std::size_t n = 0; n + 1 < up.orbits.size(); ++n) EXPECT_LT(up.orbits[n].energy, limit);
  }
  EXPECT_NEAR(test::trace_of(test::in_phase(), {.energy_to = 0.672600806149962748}).last().loop.period, 10.0, 1e-10);
  const Start start = downwards(test::family_to_twelve(test::in_phase()), 9.0);
  const test::Trace down = test::trace_of(test::pendulum(), start, {.period_limit = 12.0, .energy_from = -2.0});
  EXPECT_EQ(down.ending.reason, EndReason::energy_limit) << down.ending.text();
  EXPECT_NEAR(down.last().energy, -2.0, 1e-12);
  EXPECT_THAT(down.ending.text(), HasSubstr("E = -2"));
}

TEST(Ends, PeriodLimitIsHitExactly) {
  for (const double limit : {8.3, 9.123456789}) {
    const test::Trace trace = test::trace_of(test::in_phase(), {.period_limit = limit});
    EXPECT_EQ(trace.ending.reason, EndReason::period_limit);
    EXPECT_EQ(trace.last().loop.period, limit);
    for (std::size_t n = 0; n + 1 < trace.orbits.size(); ++n) EXPECT_LT(trace.orbits[n].loop.period, limit);
  }
}

TEST(Ends, StartsBeyondTheLimitsGiveNoOrbit) {
  for (const Options& options : {Options{.period_limit = 8.0}, Options{.energy_to = -2.9999999}}) {
    const test::Trace trace = test::trace_of(test::in_phase(), options);
    EXPECT_TRUE(trace.orbits.empty());
    EXPECT_THAT(trace.ending.text(), HasSubstr("begins beyond it, at"));
    EXPECT_FALSE(trace.ending.failed());
  }
}

TEST(Ends, StepLimit) {
  const test::Trace trace = test::trace_of(test::in_phase(), {.step_limit = 4});
  EXPECT_EQ(trace.ending.reason, EndReason::step_limit);
  EXPECT_EQ(trace.ending.text(), "step limit (4 orbits)");
  EXPECT_EQ(trace.orbits.size(), 4u);
  EXPECT_EQ(trace.last().step, 3);
}

TEST(Ends, CutoffLimit) {
  const test::Trace trace = test::trace_of(test::in_phase(), {.cutoff_to = 31});
  EXPECT_EQ(trace.ending.reason, EndReason::cutoff_limit);
  EXPECT_THAT(trace.ending.text(), HasSubstr("more than K = 31"));
  EXPECT_LE(trace.last().loop.cutoff, 31);
  EXPECT_GT(trace.last().loop.period, 8.25);
  EXPECT_LT(trace.last().loop.period, 8.6);
}

TEST(Ends, PeriodDivergenceWhereTheCutoffEndsASettledFamily) {
  const test::Trace trace = test::trace_of(test::down_up(), {.cutoff_to = 202, .fit_time_map = false});
  EXPECT_EQ(trace.ending.reason, EndReason::period_divergence) << trace.ending.text();
  EXPECT_THAT(trace.ending.text(), HasSubstr("period divergence (T = "));
  EXPECT_THAT(trace.ending.text(), HasSubstr("more than K = 202"));
  EXPECT_GT(trace.last().loop.period, 2.0 * test::down_up().period());
  EXPECT_NEAR(trace.last().energy, 3.0, 0.02);  // that of the up-up equilibrium
}

// Under its time map the family outlives its energy, which has settled to rounding by T = 80.
TEST(Ends, PeriodDivergenceFarBeyondWhereTheEnergySettles) {
  const test::Trace trace = test::trace_of(test::down_up(), {.step_limit = 400});
  EXPECT_NE(trace.ending.reason, EndReason::failure) << trace.ending.text();
  EXPECT_GT(trace.last().loop.period, 100.0);
  EXPECT_NEAR(trace.last().energy, 3.0, 1e-14);
  for (const Orbit& orbit : trace.orbits) EXPECT_LT(orbit.loss_rms, 1e-10) << "T = " << orbit.loop.period;
}

TEST(Ends, StoppedByTheObserver) {
  int seen = 0;
  const Ending ending =
      trace(test::pendulum(), test::start_of(test::in_phase()), {}, [&](const Orbit&) { return ++seen < 3; });
  EXPECT_EQ(ending.reason, EndReason::stopped);
  EXPECT_EQ(seen, 3);
  EXPECT_THAT(ending.text(), HasSubstr("stopped (T = 8.2"));
}

TEST(Ends, ArrivesAtTheFixedPoint) {
  const Start start = downwards(test::family_to_twelve(test::in_phase()), 9.0);
  const test::Trace trace = test::trace_of(test::pendulum(), start, {.period_limit = 12.0, .step_limit = 100});
  EXPECT_EQ(trace.ending.reason, EndReason::fixed_point) << trace.ending.text();
  EXPECT_NEAR(trace.last().loop.period, test::in_phase().period(), 1e-4);
}

/// Circles of the oscillator, started at the given amplitude.
Start circles(const systems::System& system) {
  loop::Loop circle = loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0 * std::numbers::pi, 10);
  circle.cosine(1, 0) = 1.0;
  circle.sine(1, 1) = -1.0;
  Start start{loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0 * std::numbers::pi, 10), circle.modes, {}};
  start.isotropy = loop::find_isotropy(system.description(), circle, 1e-9);
  return start;
}

TEST(Ends, FailureKeepsItsReason) {
  const auto walled = std::make_shared<const test::Oscillator>(0.0, 0.5);
  const test::Trace trace = test::trace_of(walled, circles(*walled), {});
  EXPECT_EQ(trace.ending.reason, EndReason::failure) << trace.ending.text();
  EXPECT_TRUE(trace.ending.failed());
  EXPECT_THAT(trace.ending.text(), HasSubstr("failure (the corrector fails at T = 6.28319 even with step"));
  EXPECT_THAT(trace.ending.text(), HasSubstr("the vector field of test_oscillator is not finite"));
  EXPECT_GT(trace.orbits.size(), 5u);
  EXPECT_NEAR(loop::state_at(trace.last().loop, 0.0)[0], 0.5, 1e-6);
  EXPECT_LE(loop::state_at(trace.last().loop, 0.0)[0], 0.5);
}

TEST(Ends, FailureAtTheVeryStart) {
  const auto walled = std::make_shared<const test::Oscillator>(0.0, -1.0);
  const test::Trace trace = test::trace_of(walled, circles(*walled), {});
  EXPECT_TRUE(trace.orbits.empty());
  EXPECT_EQ(trace.ending.reason, EndReason::failure);
  EXPECT_THAT(trace.ending.text(), HasSubstr("no orbit near the start"));
  EXPECT_THAT(trace.ending.text(), HasSubstr("not finite"));
}

TEST(Ends, NamesDiffer) {
  std::set<std::string_view> names;
  for (int n = 0; n <= static_cast<int>(EndReason::failure); ++n) names.insert(name_of(static_cast<EndReason>(n)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(EndReason::failure) + 1);
  EXPECT_EQ(names.count("unknown"), 0u);
  EXPECT_EQ((Ending{EndReason::period_limit, "T = 30"}).text(), "period limit (T = 30)");
}

TEST(Ends, MisuseThrows) {
  Start start = test::start_of(test::in_phase());
  start.direction.modes.pop_back();
  EXPECT_THROW(Branch(test::pendulum(), start, {}), core::MisuseError);
  start.direction.modes.assign(start.base.modes.size(), 0.0);
  EXPECT_THROW(Branch(test::pendulum(), start, {}), core::MisuseError);
  EXPECT_THROW(Branch(test::pendulum(), test::start_of(test::in_phase()), {.predictor_order = 0}), core::MisuseError);
  start = test::start_of(test::in_phase());
  start.base.time_map.coefficients = {0.0, 0.1};  // not even under s -> -s
  EXPECT_THROW(Branch(test::pendulum(), start, {}), core::MisuseError);
  start = test::start_of(test::in_phase());
  start.base.period = 0.0;
  EXPECT_THROW(Branch(test::pendulum(), start, {}), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::continuation
