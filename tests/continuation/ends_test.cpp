#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "corrector/oscillator.hpp"
#include "orbweaver/core/error.hpp"
#include "point_problem.hpp"
#include "support/delegating_system.hpp"

namespace orbweaver::continuation::ends_test {
namespace {

using testing::HasSubstr;
using testing::Not;

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

// T = 10 and E = 0.6726 are passed in one step: the branch ends at what comes first.
TEST(Ends, TheFirstOfTwoLimitsIsHit) {
  constexpr double energy_at_ten = 0.672600806149962748;
  const test::Trace by_energy =
      test::trace_of(test::in_phase(), {.period_limit = 10.0, .energy_to = energy_at_ten - 1e-4});
  EXPECT_EQ(by_energy.ending.reason, EndReason::energy_limit) << by_energy.ending.text();
  EXPECT_NEAR(by_energy.last().energy, energy_at_ten - 1e-4, 1e-12);
  EXPECT_LT(by_energy.last().loop.period, 10.0);
  const test::Trace by_period =
      test::trace_of(test::in_phase(), {.period_limit = 10.0, .energy_to = energy_at_ten + 1e-4});
  EXPECT_EQ(by_period.ending.reason, EndReason::period_limit) << by_period.ending.text();
  EXPECT_EQ(by_period.last().loop.period, 10.0);
  EXPECT_NEAR(by_period.last().energy, energy_at_ten, 1e-10);
}

TEST(Ends, StartsBeyondTheLimitsGiveNoOrbit) {
  for (const Options& options : {Options{.period_limit = 8.0}, Options{.energy_to = -2.9999999}}) {
    const test::Trace trace = test::trace_of(test::in_phase(), options);
    EXPECT_TRUE(trace.orbits.empty());
    EXPECT_THAT(trace.ending.text(), HasSubstr("left out: begins at"));
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

// Collocation has K = 15 at least for orbits of four equal parts.
TEST(Ends, NoOrbitHasMoreHarmonicsThanTheCutoffAllows) {
  for (const int cutoff : {8, 10, 14, 15}) {
    const test::Trace trace =
        test::trace_of(test::in_phase(), {.cutoff_from = 8, .cutoff_to = cutoff, .start_amplitude = 1e-4});
    EXPECT_EQ(trace.ending.reason, EndReason::cutoff_limit) << trace.ending.text();
    ASSERT_FALSE(trace.orbits.empty()) << cutoff << ": " << trace.ending.text();
    for (const Orbit& orbit : trace.orbits) EXPECT_LE(orbit.loop.cutoff, cutoff);
  }
  EXPECT_THROW(
      (void)test::trace_of(test::in_phase(), {.corrector = {.method = corrector::Method::collocation}, .cutoff_to = 8}),
      core::InputError);
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
  start.isotropy = loop::find_isotropy(system.structure(), circle, 1e-9);
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

/// Keeps the states at which an oscillator's field is asked for, of many at once.
class Recorder final : public test::DelegatingSystem {
 public:
  using DelegatingSystem::DelegatingSystem;
  void field(std::size_t nodes, const double* z, double* f) const override {
    asked.emplace_back(z, z + 2 * nodes);
    DelegatingSystem::field(nodes, z, f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    asked.emplace_back(z, z + 2 * nodes);
    DelegatingSystem::field_jacobian(nodes, z, f, jacobian);
  }

  mutable std::vector<std::vector<double>> asked;
};

TEST(Ends, NoWholeLoopIsTriedTwiceAtTheVeryStart) {
  const auto walled = std::make_shared<const Recorder>(std::make_shared<const test::Oscillator>(0.0, -1.0));
  Options options;
  options.corrector.method = corrector::Method::newton_krylov;
  const test::Trace trace = test::trace_of(walled, circles(*walled), options);
  EXPECT_THAT(trace.ending.text(), HasSubstr("no orbit near the start"));
  const std::set<std::vector<double>> different(walled->asked.begin(), walled->asked.end());
  EXPECT_GT(different.size(), 3U);
  EXPECT_EQ(walled->asked.size(), different.size());
}

// A slow oscillation leaves nothing to fit: a second attempt would be the first again.
TEST(Ends, NoCellIsFittedAtTheVeryStartThatNeedsNoFit) {
  const auto walled = std::make_shared<const Recorder>(std::make_shared<const test::Oscillator>(0.0, -1.0));
  const test::Trace trace = test::trace_of(walled, circles(*walled), {});
  EXPECT_THAT(trace.ending.text(), HasSubstr("no orbit near the start"));
  const std::multiset<std::vector<double>> all(walled->asked.begin(), walled->asked.end());
  const std::set<std::vector<double>> different(walled->asked.begin(), walled->asked.end());
  std::size_t most = 0;
  for (const std::vector<double>& states : different) most = std::max(most, all.count(states));
  EXPECT_GT(different.size(), 3U);
  EXPECT_LE(most, 2U) << "by the corrector, and by the look for what is not finite";
}

/// q' = p, p' = -q - stiffness q^3: the period depends on the amplitude. The field is NaN where |p| > wall.
class Spring final : public test::StatedSystem {
 public:
  Spring(double stiffness, double wall)
      : StatedSystem(test::Oscillator(0.0).structure(), "test_spring"), _stiffness(stiffness), _wall(wall) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      f[j] = z[nodes + j];
      f[nodes + j] = std::abs(z[nodes + j]) > _wall ? std::numeric_limits<double>::quiet_NaN()
                                                    : -z[j] * (1.0 + _stiffness * z[j] * z[j]);
    }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      jacobian[j] = jacobian[3 * nodes + j] = 0.0;
      jacobian[nodes + j] = 1.0;
      jacobian[2 * nodes + j] = -1.0 - 3.0 * _stiffness * z[j] * z[j];
    }
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[1] * z[1] + z[0] * z[0] * (1.0 + 0.5 * _stiffness * z[0] * z[0]));
  }

 private:
  double _stiffness;
  double _wall;
};

struct FirstTrial {
  Trial trial;
  double period;
};

/// The correction at amplitude 0.01 from the equilibrium's period.
FirstTrial first_trial(const Spring& spring) {
  constexpr double amplitude = 0.01;
  const Start start = circles(spring);
  ProblemState state;
  const Options options;
  const auto problem = make_point_problem({spring, start.base, start.isotropy}, options, state);
  problem->resolve(problem->resolution_for(10, {}, 100));
  state.amplitude = amplitude;
  Prediction prediction{problem->from_loop(start.base),
                        problem->from_change(loop::perturbation(start.base, start.direction)), 1};
  for (std::size_t n = 0; n < prediction.values.size(); ++n) prediction.values[n] += amplitude * prediction.tangent[n];
  const std::vector<double> conditions = problem->conditions_at(prediction);
  FirstTrial out{problem->correct(std::move(prediction), conditions), 0.0};
  out.period = out.trial.values[problem->scalars_at()];
  return out;
}

// The correction takes T below 0 and the loop to where the field is NaN: there is no orbit of this amplitude.
TEST(Ends, NotFiniteWhereThePeriodIsLost) {
  const FirstTrial first = first_trial(Spring(-1.5e4, 0.02));
  EXPECT_FALSE(first.trial.converged);
  EXPECT_LT(first.period, 0.0);
  EXPECT_THAT(first.trial.reason, HasSubstr("the vector field of test_spring is not finite"));
}

/// The pendulum whose field is NaN where the outer angle is between two values.
class Strip final : public test::DelegatingSystem {
 public:
  Strip(double from, double to) : DelegatingSystem(test::pendulum()), _from(from), _to(to) {}
  void field(std::size_t nodes, const double* z, double* f) const override {
    DelegatingSystem::field(nodes, z, f);
    spoil(nodes, z, f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    DelegatingSystem::field_jacobian(nodes, z, f, jacobian);
    spoil(nodes, z, f);
  }

 private:
  void spoil(std::size_t nodes, const double* z, double* f) const {
    for (std::size_t j = 0; j < nodes; ++j)
      if (std::abs(z[nodes + j]) > _from && std::abs(z[nodes + j]) < _to)
        f[2 * nodes + j] = std::numeric_limits<double>::quiet_NaN();
  }
  double _from;
  double _to;
};

// By collocation the field is asked for in the middles of cells, which may be the only places in a narrow strip; and
// where all of a loop is in it, the preconditioner cannot be built.
TEST(Ends, NotFiniteSaysAtWhichStateByEveryMethod) {
  for (const auto& [from, to] : {std::pair(0.05, 0.06), std::pair(0.05, 10.0)}) {
    Options options{.step_limit = 40};
    options.start_amplitude = 0.3;
    for (const auto method : {corrector::Method::collocation, corrector::Method::newton_krylov}) {
      options.corrector.method = method;
      const test::Trace trace =
          test::trace_of(std::make_shared<const Strip>(from, to), test::start_of(test::in_phase()), options);
      EXPECT_TRUE(trace.ending.failed());
      EXPECT_THAT(trace.ending.text(), HasSubstr("the vector field of double_pendulum is not finite (nan) at t = "));
      EXPECT_THAT(trace.ending.text(), HasSubstr("state ("));
    }
  }
}

TEST(Ends, DivergenceSaysHowFar) {
  const FirstTrial first = first_trial(Spring(-1.1e4, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(first.trial.converged);
  EXPECT_THAT(first.trial.reason, HasSubstr("no convergence in 1 iteration, the last change "));
  EXPECT_THAT(first.trial.reason, Not(testing::EndsWith(" 0")));
}

// The arclength of a step is then a dozen times the problem's length of it.
TEST(Ends, JumpsAreGivenUpWhereThePeriodChangesFast) {
  const auto spring = std::make_shared<const Spring>(1e3, std::numeric_limits<double>::infinity());
  int asked = 0;
  constexpr int too_often = 200;
  Options options{.step_limit = 4};
  options.start_amplitude = 0.05;
  options.jumped = [&](const Orbit&, const Orbit&) { return ++asked % too_often != 0; };
  (void)test::trace_of(spring, circles(*spring), options);
  EXPECT_LT(asked, too_often);
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
}  // namespace orbweaver::continuation::ends_test
