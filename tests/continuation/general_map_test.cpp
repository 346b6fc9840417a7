// Long branches without the symmetries of a pulse: general time maps, fitted on the way.
#include <cmath>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::continuation::general_map_test {
namespace {

/// The out-phase family as if it had no more symmetry than its reversor, or none.
loop::Isotropy less_symmetry(bool reversor) {
  loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  std::erase_if(isotropy, [&](const loop::SymmetryElement& g) { return !(g.reversing && reversor); });
  return isotropy;
}

class GeneralMaps : public testing::TestWithParam<bool> {};

TEST_P(GeneralMaps, ServeBranchesWithFewSymmetries) {
  // The pulse serves the loops with a reversor up to T = 17.
  const Options options{.general_map_cells = 192, .period_limit = GetParam() ? 24.0 : 12.0};
  Start start = test::start_of(test::out_phase());
  start.isotropy = less_symmetry(GetParam());
  const test::Trace mapped = test::trace_of(test::pendulum(), start, options);
  const Orbit symmetric = test::trace_of(test::out_phase(), options).last();
  ASSERT_EQ(mapped.ending.reason, EndReason::period_limit) << mapped.ending.text();
  const loop::Loop& last = mapped.last().loop;
  EXPECT_FALSE(last.time_map.coefficients.empty());
  EXPECT_LT(last.cutoff, symmetric.loop.cutoff);
  EXPECT_NEAR(mapped.last().energy, symmetric.energy, 1e-11);
  for (const Orbit& orbit : mapped.orbits) {
    const loss::Linearization whole(*test::pendulum(), orbit.loop, loss::Linearization::Order::residual);
    EXPECT_LT(std::sqrt(whole.loss()), 1e-10 * std::min(1.0, loop::rms_speed(orbit.loop))) << orbit.loop.period;
    EXPECT_TRUE(loop::is_invariant(orbit.loop.time_map, start.isotropy)) << orbit.loop.period;
  }
}

// From an orbit with many harmonics the branch goes over to a map with fewer at once: the frontier's tangent is that of
// the orbit as it was accepted.
TEST_P(GeneralMaps, LeaveTheTangentAsItIs) {
  const std::vector<Orbit>& orbits = test::even_family_to_twelve(test::out_phase()).orbits;
  Start start;
  start.base = orbits[orbits.size() - 6].loop;
  start.isotropy = less_symmetry(GetParam());
  start.direction.modes = loop::with_cutoff(orbits[orbits.size() - 5].loop, start.base.cutoff).modes;
  for (std::size_t n = 0; n < start.base.modes.size(); ++n) start.direction.modes[n] -= start.base.modes[n];
  Branch branch(test::pendulum(), start, {.general_map_cells = 192});
  const Orbit orbit = branch.advance().value();
  const Frontier& frontier = branch.frontier();
  ASSERT_FALSE(frontier.problem.resolution.time_map == orbit.loop.time_map);
  EXPECT_LT(frontier.problem.resolution.size, 0.6 * (2 * orbit.loop.cutoff + 1) / (GetParam() ? 2 : 1));
  const double h = 1e-4;
  const auto beside = [&](double period) {
    const corrector::Result result = orbit_at_period(*test::pendulum(), orbit.loop, start.isotropy, period, {});
    return loop::with_cutoff(result.loop, orbit.loop.cutoff).modes;
  };
  const std::vector<double> above = beside(orbit.loop.period + h);
  const std::vector<double> below = beside(orbit.loop.period - h);
  ASSERT_EQ(frontier.tangent.modes.size(), orbit.loop.modes.size());
  for (std::size_t n = 0; n < above.size(); ++n)
    ASSERT_NEAR((above[n] - below[n]) / (2.0 * h), frontier.tangent.modes[n] / frontier.tangent.period(), 1e-5) << n;
}

INSTANTIATE_TEST_SUITE_P(Continuation, GeneralMaps, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Reversor" : "WholeLoop"; });

}  // namespace
}  // namespace orbweaver::continuation::general_map_test
