#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::continuation::families_test {
namespace {

class Families : public testing::TestWithParam<test::PendulumMode> {
 protected:
  [[nodiscard]] const test::Trace& family() const { return test::family_to_twelve(GetParam()); }
};

TEST_P(Families, EndExactlyOnThePeriodLimit) {
  EXPECT_EQ(family().ending.reason, EndReason::period_limit);
  EXPECT_EQ(family().ending.text(), "period limit (T = 12)");
  EXPECT_EQ(family().last().loop.period, 12.0);
}

TEST_P(Families, StartHalfADegreeFromTheEquilibrium) {
  const Orbit& first = family().orbits.front();
  EXPECT_EQ(first.step, 0);
  EXPECT_EQ(first.arclength, 0.0);
  const std::vector<double> z = loop::state_at(first.loop, 0.0);
  EXPECT_NEAR(std::hypot(z[0] - GetParam().point[0], z[1] - GetParam().point[1]), 8.7e-3, 1e-4 * 8.7e-3);
  EXPECT_NEAR(first.loop.period, GetParam().period(), 1e-3);
}

TEST_P(Families, EveryOrbitIsAnOrbit) {
  for (const Orbit& orbit : family().orbits) {
    const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::residual);
    const double rms = std::sqrt(linearization.loss());
    EXPECT_LT(rms, 1e-10 * std::min(1.0, loop::rms_speed(orbit.loop))) << "T = " << orbit.loop.period;
    EXPECT_NEAR(orbit.loss_rms, rms, 1e-14 + 0.2 * rms)  // two quadratures of the same mean
        << "T = " << orbit.loop.period;
    EXPECT_EQ(orbit.tail, loop::tail(orbit.loop));
    EXPECT_LE(orbit.tail, 1e-12);
    EXPECT_TRUE(std::isnan(orbit.off_branch_eigenvalue)) << "not asked for";
  }
}

// The fast way (collocation, stale factor) against Newton's method on the assembled Hessian.
TEST_P(Families, OrbitsAreThoseOfTheDenseSolver) {
  const auto& orbits = family().orbits;
  Options dense;
  dense.corrector.method = corrector::Method::nls;
  for (const std::size_t n : {orbits.size() / 4, orbits.size() / 2, orbits.size() - 1}) {
    const loop::Loop& fast = orbits[n].loop;
    loop::Loop guess = fast;
    for (std::size_t m = 4; m < guess.modes.size(); ++m) guess.modes[m] *= 1.0 + 1e-6;  // the mean belongs to S
    const corrector::Result result =
        orbit_at_period(*test::pendulum(), guess, test::pendulum_isotropy(*test::pendulum()), fast.period, dense);
    ASSERT_TRUE(result.converged()) << result.detail;
    EXPECT_LT(loop::mean_distance(result.loop, fast), 2e-11) << "T = " << fast.period;
    EXPECT_NEAR(energy_of(*test::pendulum(), result.loop), orbits[n].energy, 1e-11);
  }
}

TEST_P(Families, EnergyIsConstantAlongEveryLoop) {
  for (const Orbit& orbit : family().orbits) {
    const double energy = test::pendulum()->conserved(0, loop::state_at(orbit.loop, 0.0));
    EXPECT_EQ(orbit.energy, energy);
    for (int n = 1; n < 40; ++n)
      EXPECT_NEAR(test::pendulum()->conserved(0, loop::state_at(orbit.loop, orbit.loop.period * n / 40.0)), energy,
                  2e-11)
          << "T = " << orbit.loop.period << ", n = " << n;
  }
}

TEST_P(Families, KeepTheirIsotropyAndBeginAtRest) {
  for (const Orbit& orbit : family().orbits) {
    EXPECT_EQ(loop::to_text(loop::find_isotropy(test::pendulum()->structure(), orbit.loop, 1e-12)), "S@1/2 R@0");
    const std::vector<double> z = loop::state_at(orbit.loop, 0.0);
    EXPECT_EQ(z[2], 0.0);
    EXPECT_EQ(z[3], 0.0);
  }
}

TEST_P(Families, StepsAndArclengthCountUp) {
  for (std::size_t n = 1; n < family().orbits.size(); ++n) {
    const Orbit& before = family().orbits[n - 1];
    const Orbit& orbit = family().orbits[n];
    EXPECT_EQ(orbit.step, before.step + 1);
    EXPECT_NEAR(orbit.arclength - before.arclength, arclength_between(before.loop, orbit.loop), 1e-12);
    EXPECT_GT(orbit.loop.period, before.loop.period);
    EXPECT_GT(orbit.energy, before.energy);
    EXPECT_GT(orbit.action, before.action);
  }
}

// dW/dE = T: by Cauchy's mean value theorem the chord between neighbours is a period between theirs, whatever the step.
// The energies of tiny loops are differences of numbers of order 1: 1e-15 over their distance.
TEST_P(Families, ChordOfActionAgainstEnergyIsAPeriodBetween) {
  for (std::size_t n = 1; n < family().orbits.size(); ++n) {
    const Orbit& a = family().orbits[n - 1];
    const Orbit& b = family().orbits[n];
    const double rounding = 3e-14 * b.loop.period / (b.energy - a.energy);
    const double chord = (b.action - a.action) / (b.energy - a.energy);
    EXPECT_GT(chord, a.loop.period - rounding) << n;
    EXPECT_LT(chord, b.loop.period + rounding) << n;
  }
}

// Centred differences over T +- h: second order in h, and one Richardson step leaves the fourth.
TEST_P(Families, DerivativeOfActionByEnergyIsThePeriod) {
  for (const double period : {7.0, 9.5, 11.0}) {
    if (period - 0.1 < GetParam().period()) continue;
    double error[3];
    for (int level = 0; level < 3; ++level) {
      const double h = 0.08 / (1 << level);
      const corrector::Result below = test::orbit_at(family(), period - h);
      const corrector::Result above = test::orbit_at(family(), period + h);
      ASSERT_TRUE(below.converged() && above.converged()) << below.detail << above.detail;
      const systems::System& system = *test::pendulum();
      error[level] = (action_of(system, above.loop) - action_of(system, below.loop)) /
                         (energy_of(system, above.loop) - energy_of(system, below.loop)) -
                     period;
    }
    EXPECT_LT(std::abs(error[0]), 0.05) << period;
    EXPECT_NEAR(error[0] / error[1], 4.0, 0.1) << period;
    EXPECT_NEAR(error[1] / error[2], 4.0, 0.05) << period;
    EXPECT_LT(std::abs((4.0 * error[2] - error[1]) / 3.0), 1e-6) << period;
  }
}

INSTANTIATE_TEST_SUITE_P(Continuation, Families, testing::ValuesIn(test::pendulum_modes()), [](const auto& tested) {
  std::string name = tested.param.name;
  std::erase(name, '-');
  return name;
});

struct Known {
  test::PendulumMode mode;
  double period;
  double energy;
  double first;  ///< angles at rest; NaN: not known
  double second;
};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class KnownOrbits : public testing::TestWithParam<Known> {};

TEST_P(KnownOrbits, AtExactPeriods) {
  const auto& [mode, period, energy, first, second] = GetParam();
  const corrector::Result orbit = test::orbit_at(test::family_to_twelve(mode), period);
  ASSERT_TRUE(orbit.converged()) << orbit.detail;
  EXPECT_EQ(orbit.loop.period, period);
  EXPECT_NEAR(energy_of(*test::pendulum(), orbit.loop), energy, 1e-11);
  const std::vector<double> z = loop::state_at(orbit.loop, 0.0);
  if (!std::isnan(first)) {
    EXPECT_NEAR(z[0], first, 1e-11);
  }
  if (!std::isnan(second)) {
    EXPECT_NEAR(z[1], second, 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Continuation, KnownOrbits,
    testing::Values(Known{test::in_phase(), 9.0, -0.764030789928, 1.360312422366, unknown},
                    Known{test::in_phase(), 10.0, 0.672600806149962748, 1.967771207822545712, 1.469965875029166716},
                    Known{test::in_phase(), 12.0, 1.970233795765, 2.450713379215, unknown},
                    Known{test::out_phase(), 10.0, 1.786332680018399959, 2.332086592672098646, -1.98954818895168323},
                    Known{test::out_phase(), 12.0, 2.844918147648534309, unknown, unknown},
                    Known{test::down_up(), 10.0, 2.790301691843931528, unknown, unknown},
                    Known{test::up_down(), 10.0, 2.901693655326266116, unknown, unknown}));

// Pinned: a change of these numbers is a change of the step control, to be made knowingly.
TEST(Families, StepCountsAndCutoffsAtTwelve) {
  struct Pinned {
    test::PendulumMode mode;
    int steps;
    int cutoff;
  };
  for (const Pinned& pinned : {Pinned{test::in_phase(), 23, 111}, Pinned{test::out_phase(), 37, 191},
                               Pinned{test::down_up(), 21, 79}, Pinned{test::up_down(), 21, 79}}) {
    const test::Trace& family = test::family_to_twelve(pinned.mode);
    EXPECT_EQ(family.last().step, pinned.steps) << pinned.mode.name;
    EXPECT_EQ(family.last().loop.cutoff, pinned.cutoff) << pinned.mode.name;
    for (const Orbit& orbit : family.orbits)
      EXPECT_LE(orbit.iterations, 12) << pinned.mode.name << " step " << orbit.step;
  }
}

TEST(Families, DoNotDependOnTheCorrector) {
  const double energy = test::trace_of(test::in_phase(), {.period_limit = 8.4}).last().energy;
  for (const corrector::Method method :
       {corrector::Method::newton_krylov, corrector::Method::brgn, corrector::Method::nls, corrector::Method::ntr}) {
    const test::Trace trace = test::trace_of(test::in_phase(), {.corrector = {.method = method}, .period_limit = 8.4});
    EXPECT_EQ(trace.ending.reason, EndReason::period_limit) << name_of(method) << ": " << trace.ending.text();
    EXPECT_NEAR(trace.last().energy, energy, 1e-11) << name_of(method);
  }
}

// Whole loops by the same tracer: the steps are its own, the families the same.
TEST(Families, WholeLoopsTakeAsFewSteps) {
  const test::Trace& fast = test::family_to_twelve(test::in_phase());
  const test::Trace whole = test::trace_of(
      test::in_phase(), {.corrector = {.method = corrector::Method::newton_krylov}, .period_limit = 12.0});
  ASSERT_EQ(whole.ending.reason, EndReason::period_limit) << whole.ending.text();
  EXPECT_NEAR(whole.last().energy, fast.last().energy, 1e-11);
  EXPECT_EQ(whole.last().step, 21) << "pinned: a change of the step control";
}

TEST(Families, ByCollocationHaveTheBitsOfAutomatic) {
  const test::Trace named =
      test::trace_of(test::in_phase(), {.corrector = {.method = corrector::Method::collocation}, .period_limit = 9.0});
  const test::Trace automatic = test::trace_of(test::in_phase(), {.period_limit = 9.0});
  ASSERT_EQ(named.orbits.size(), automatic.orbits.size());
  EXPECT_EQ(named.last().loop.modes, automatic.last().loop.modes);
}

TEST(Families, CollocationSaysWhereItDoesNotApply) {
  Start start = test::start_of(test::in_phase());
  for (loop::SymmetryElement& element : start.isotropy)
    if (element.reversing) {
      element.shift_numerator = 1;
      element.shift_denominator = 4;
    }
  Options options;
  EXPECT_NO_THROW(Branch(test::pendulum(), start, options));
  options.corrector.method = corrector::Method::collocation;
  try {
    Branch(test::pendulum(), start, options);
    ADD_FAILURE() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("the corrector `collocation` does not apply to loops of double_pendulum"));
    EXPECT_THAT(error.what(), testing::HasSubstr("use `automatic`"));
  }
}

TEST(Families, RepeatBitForBit) {
  const test::Trace again = test::trace_of(test::in_phase(), {.period_limit = 12.0});
  const test::Trace& once = test::family_to_twelve(test::in_phase());
  ASSERT_EQ(again.orbits.size(), once.orbits.size());
  for (std::size_t n = 0; n < again.orbits.size(); ++n) {
    EXPECT_EQ(again.orbits[n].loop.modes, once.orbits[n].loop.modes) << n;
    EXPECT_EQ(again.orbits[n].loop.period, once.orbits[n].loop.period) << n;
  }
}

// Between two orbits the place decides which one is found, not what has been found before.
TEST(FamilyCurves, AnOrbitHasOnePlace) {
  const test::Trace& trace = test::even_family_to_twelve(test::in_phase());
  for (const corrector::Method method : {corrector::Method::automatic, corrector::Method::newton_krylov})
    for (const std::size_t n : {2u, 10u, 15u}) {
      const Options options{.corrector = {.method = method}, .fit_time_map = false};
      const Orbit& first = trace.orbits[n];
      const Orbit& last = trace.orbits[n + 1];
      const auto period_at = [&](const std::vector<double>& shares) {
        FamilyCurve curve(test::pendulum(), test::pendulum_isotropy(*test::pendulum()), options);
        curve.add(first.arclength, first.loop, 2);
        curve.add(last.arclength, last.loop, 2);
        std::optional<CurvePoint> found;
        for (const double share : shares)
          found = curve.at(first.arclength + share * (last.arclength - first.arclength), false);
        return found ? found->loop.period : std::nan("");
      };
      const double at_once = period_at({0.3});
      EXPECT_NEAR(period_at({0.6, 0.3}), at_once, 1e-10) << n;
      EXPECT_NEAR(period_at({0.6, 0.1, 0.35, 0.3}), at_once, 1e-10) << n;
    }
}

}  // namespace
}  // namespace orbweaver::continuation::families_test
