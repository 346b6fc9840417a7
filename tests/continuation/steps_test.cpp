#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::continuation::steps_test {
namespace {

constexpr double half_degree = 0.5 * std::numbers::pi / 180.0;

double state_distance(const loop::Loop& a, const loop::Loop& b) {
  const std::vector<double> z = loop::state_at(a, 0.0);
  const std::vector<double> w = loop::state_at(b, 0.0);
  double square = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) square += (z[i] - w[i]) * (z[i] - w[i]);
  return std::sqrt(square);
}

/// What of a - b lies along the tangent.
double along_tangent(const loop::Loop& a, const loop::Loop& b, const Frontier& frontier) {
  double sum = (a.period - b.period) * frontier.tangent.period();
  const loop::Loop padded = loop::with_cutoff(b, a.cutoff);
  for (std::size_t n = 0; n < frontier.tangent.modes.size(); ++n)
    sum += (a.modes[n] - padded.modes[n]) * frontier.tangent.modes[n];
  return sum;
}

// The prediction moves z(s = 0) by exactly half a degree; the corrector's change is orthogonal to the tangent.
TEST(FixedStep, PredictsHalfADegree) {
  for (const test::PendulumMode& mode : {test::in_phase(), test::up_down()}) {
    const corrector::Options dense{.method = corrector::Method::nls};
    Branch branch(test::pendulum(), test::start_of(mode),
                  {.corrector = dense, .fixed_step = half_degree, .predictor = Predictor::tangent, .step_limit = 30});
    ASSERT_TRUE(branch.advance().has_value());
    while (true) {
      const Frontier before = branch.frontier();
      const std::optional<Orbit> orbit = branch.advance();
      if (!orbit) break;
      const loop::Loop& here = before.orbit.loop;
      const double length = half_degree / state_distance(here, loop::moved(here, before.tangent, 1.0));
      const loop::Loop predicted = loop::moved(here, before.tangent, length);
      EXPECT_NEAR(state_distance(here, predicted), half_degree, 1e-12);
      const double change = state_distance(predicted, orbit->loop);
      EXPECT_LT(change, 0.02 * half_degree) << orbit->step;
      EXPECT_NEAR(state_distance(here, orbit->loop), half_degree, change + 1e-12) << orbit->step;
      EXPECT_NEAR(along_tangent(orbit->loop, predicted, before), 0.0, 1e-12) << orbit->step;
    }
    EXPECT_EQ(branch.ending()->reason, EndReason::step_limit);
  }
}

// What is looked for between orbits hangs on how long the step was beside one that the branch would choose.
TEST(FixedStep, SaysHowOftenItIsToBeHalved) {
  const auto most_halvings = [](std::optional<double> fixed_step) {
    int most = 0;
    Branch branch(test::pendulum(), test::start_of(test::in_phase()),
                  {.fixed_step = fixed_step, .largest_step = 2.0, .step_limit = 12});
    while (const std::optional<Orbit> orbit = branch.advance())
      if (orbit->step > 3) most = std::max(most, orbit->halvings);
    return most;
  };
  EXPECT_EQ(most_halvings(half_degree), 0);
  EXPECT_EQ(most_halvings(std::nullopt), 0);
  EXPECT_GE(most_halvings(0.6), 1);
}

// By collocation the prediction is a polynomial; the orbits themselves lie half a degree apart.
TEST(FixedStep, OrbitsLieHalfADegreeApart) {
  for (const test::PendulumMode& mode : {test::in_phase(), test::up_down()}) {
    const test::Trace trace = test::trace_of(mode, {.fixed_step = half_degree, .step_limit = 30});
    ASSERT_EQ(trace.orbits.size(), 30u);
    for (std::size_t n = 2; n < trace.orbits.size(); ++n)
      EXPECT_NEAR(state_distance(trace.orbits[n - 1].loop, trace.orbits[n].loop), half_degree, 1e-3 * half_degree) << n;
  }
}

TEST(FixedStep, ReachesTheSameOrbitsAsAdaptiveSteps) {
  const test::Trace fixed = test::trace_of(test::down_up(), {.fixed_step = half_degree, .period_limit = 5.5});
  const test::Trace adaptive = test::trace_of(test::down_up(), {.period_limit = 5.5});
  EXPECT_EQ(fixed.ending.reason, EndReason::period_limit);
  EXPECT_GT(fixed.orbits.size(), 5 * adaptive.orbits.size());
  EXPECT_NEAR(fixed.last().energy, adaptive.last().energy, 1e-11);
}

struct TinyStart {
  test::PendulumMode mode;
  double amplitude;
};

class TinyStarts : public testing::TestWithParam<TinyStart> {};

TEST_P(TinyStarts, GrowOntoTheFamily) {
  const auto& [mode, amplitude] = GetParam();
  const double limit = 1.01 * mode.period();
  const test::Trace trace = test::trace_of(mode, {.start_amplitude = amplitude, .period_limit = limit});
  ASSERT_EQ(trace.ending.reason, EndReason::period_limit) << trace.ending.text();
  const std::vector<double> z = loop::state_at(trace.orbits.front().loop, 0.0);
  EXPECT_NEAR(std::hypot(z[0] - mode.point[0], z[1] - mode.point[1]), amplitude, 1e-3 * amplitude);
  EXPECT_EQ(trace.last().loop.period, limit);
  const corrector::Result reference = test::orbit_at(test::family_to_twelve(mode), limit);
  ASSERT_TRUE(reference.converged()) << reference.detail;
  EXPECT_NEAR(trace.last().energy, energy_of(*test::pendulum(), reference.loop), 1e-11);
  EXPECT_LT(loop::mean_distance(trace.last().loop, reference.loop), 1e-9);
  EXPECT_LT(trace.orbits.size(), 45u);
}

INSTANTIATE_TEST_SUITE_P(Continuation, TinyStarts,
                         testing::Values(TinyStart{test::in_phase(), 1e-4}, TinyStart{test::in_phase(), 1e-8},
                                         TinyStart{test::down_up(), 1e-4}, TinyStart{test::down_up(), 1e-8}),
                         [](const auto& tested) {
                           std::string name =
                               tested.param.mode.name + (tested.param.amplitude < 1e-6 ? "1em8" : "1em4");
                           std::erase(name, '-');
                           return name;
                         });

// From far too many harmonics the cutoff falls to what small loops need, and rises again with the amplitude.
TEST(Resolution, GoesDownAndUp) {
  const test::Trace trace =
      test::trace_of(test::pendulum(), test::start_of(test::in_phase(), 112), {.period_limit = 9.0});
  EXPECT_EQ(trace.ending.reason, EndReason::period_limit);
  EXPECT_GE(trace.orbits.front().loop.cutoff, 112);
  int lowest = 112;
  for (const Orbit& orbit : trace.orbits) lowest = std::min(lowest, orbit.loop.cutoff);
  EXPECT_LE(lowest, 31);
  EXPECT_GE(trace.last().loop.cutoff, 63);
  EXPECT_NEAR(trace.last().energy, -0.764030789928, 1e-11);
}

TEST(Resolution, NeverBelowTheScenesLeast) {
  const test::Trace trace = test::trace_of(test::in_phase(), {.cutoff_from = 40, .step_limit = 6});
  for (const Orbit& orbit : trace.orbits) EXPECT_GE(orbit.loop.cutoff, 40);
}

TEST(Frontiers, AreConsistent) {
  Branch branch(test::pendulum(), test::start_of(test::in_phase()), {.period_limit = 9.0});
  loop::Loop first;
  std::optional<Orbit> before;
  while (const std::optional<Orbit> orbit = branch.advance()) {
    const Frontier& frontier = branch.frontier();
    if (orbit->step == 0) first = orbit->loop;
    EXPECT_EQ(frontier.first.modes, first.modes);
    EXPECT_EQ(frontier.orbit.step, orbit->step);
    EXPECT_EQ(frontier.orbit.energy, orbit->energy);
    EXPECT_EQ(frontier.orbit.loop.period, orbit->loop.period);
    EXPECT_LT(loop::mean_distance(frontier.orbit.loop, orbit->loop), 1e-13);
    ASSERT_EQ(frontier.tangent.modes.size(), frontier.orbit.loop.modes.size());
    EXPECT_NEAR(frontier.tangent.norm(), 1.0, 1e-12);
    EXPECT_GT(frontier.next_length, 0.0);
    if (before) {
      EXPECT_NEAR(frontier.last_increment, arclength_between(before->loop, orbit->loop), 1e-12);
      EXPECT_NEAR(orbit->arclength, before->arclength + frontier.last_increment, 1e-14 * orbit->arclength);
    }
    before = orbit;
  }
  ASSERT_TRUE(branch.ending().has_value());
  EXPECT_FALSE(branch.advance().has_value()) << "an ended branch stays ended";
}

// Steps are a function of the frontier, by both problems, whoever has asked for a tangent on the way.
TEST(Frontiers, GoOnWithTheSameBits) {
  for (const corrector::Method method : {corrector::Method::collocation, corrector::Method::newton_krylov}) {
    const Options options{.corrector = {.method = method}, .step_limit = 12};
    const test::Trace whole = test::trace_of(test::in_phase(), options);
    ASSERT_EQ(whole.orbits.size(), 12u);
    Branch first(test::pendulum(), test::start_of(test::in_phase()), options);
    for (int n = 0; n < 6; ++n) ASSERT_TRUE(first.advance());
    EXPECT_FALSE(first.frontier().tangent.empty());
    Branch second(test::pendulum(), test::start_of(test::in_phase()), options, first.restart_frontier());
    for (std::size_t n = 6; n < 12; ++n) {
      const std::optional<Orbit> orbit = second.advance();
      ASSERT_TRUE(orbit);
      EXPECT_EQ(orbit->loop.modes, whole.orbits[n].loop.modes) << name_of(method) << " step " << n;
      EXPECT_EQ(orbit->loop.period, whole.orbits[n].loop.period) << name_of(method) << " step " << n;
    }
  }
}

// The tangent is the derivative of the family: centred differences of the orbits at T +- h.
TEST(Frontiers, TangentPointsAlongTheFamily) {
  Branch branch(test::pendulum(), test::start_of(test::down_up()), {.period_limit = 8.0});
  while (branch.advance() && branch.frontier().orbit.loop.period < 6.5) {
  }
  const Frontier& frontier = branch.frontier();
  const loop::Loop& here = frontier.orbit.loop;
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  const double h = 1e-3;
  const loop::Loop above =
      loop::with_cutoff(orbit_at_period(*test::pendulum(), here, isotropy, here.period + h, {}).loop, here.cutoff);
  const loop::Loop below =
      loop::with_cutoff(orbit_at_period(*test::pendulum(), here, isotropy, here.period - h, {}).loop, here.cutoff);
  for (std::size_t n = 0; n < here.modes.size(); ++n)
    EXPECT_NEAR((above.modes[n] - below.modes[n]) / (2.0 * h), frontier.tangent.modes[n] / frontier.tangent.period(),
                1e-5)
        << n;
}

}  // namespace
}  // namespace orbweaver::continuation::steps_test
