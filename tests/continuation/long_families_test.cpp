#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::continuation::long_families_test {
namespace {

const test::Trace& family_to_thirty(const test::PendulumMode& mode) {
  static std::map<std::string, test::Trace> traced;
  if (traced.count(mode.name) == 0) traced[mode.name] = test::trace_of(mode, {.period_limit = 30.0});
  return traced[mode.name];
}

void expect_orbits(const test::Trace& trace) {
  ASSERT_EQ(trace.ending.reason, EndReason::period_limit) << trace.ending.text();
  EXPECT_EQ(trace.last().loop.period, 30.0);
  for (const Orbit& orbit : trace.orbits) {
    const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::residual);
    EXPECT_LT(std::sqrt(linearization.loss()), 1e-10 * std::min(1.0, loop::rms_speed(orbit.loop)))
        << "T = " << orbit.loop.period;
    for (int n = 1; n < 40; ++n)
      EXPECT_NEAR(test::pendulum()->conserved(0, loop::state_at(orbit.loop, orbit.loop.period * n / 40.0)),
                  orbit.energy, 2e-11)
          << "T = " << orbit.loop.period;
  }
  for (std::size_t n = 1; n < trace.orbits.size(); ++n) {
    const Orbit& a = trace.orbits[n - 1];
    const Orbit& b = trace.orbits[n];
    const double rounding = 1e-13 * b.loop.period / (b.energy - a.energy);
    EXPECT_GT((b.action - a.action) / (b.energy - a.energy), a.loop.period - rounding) << n;
    EXPECT_LT((b.action - a.action) / (b.energy - a.energy), b.loop.period + rounding) << n;
  }
}

/// The larger angle between the two rods and the upward vertical at rest, degrees.
double degrees_from_upright(const loop::Loop& loop) {
  const std::vector<double> z = loop::state_at(loop, 0.0);
  const double first = std::abs(std::remainder(z[0] - std::numbers::pi, 2.0 * std::numbers::pi));
  const double second = std::abs(std::remainder(z[1] - std::numbers::pi, 2.0 * std::numbers::pi));
  return std::max(first, second) * 180.0 / std::numbers::pi;
}

TEST(LongFamilies, InPhaseToThirty) {
  const test::Trace& trace = family_to_thirty(test::in_phase());
  expect_orbits(trace);
  EXPECT_NEAR(trace.last().energy, 2.999066436174782438, 1e-11);
  EXPECT_NEAR(energy_of(*test::pendulum(), test::orbit_at(trace, 15.0).loop), 2.693928090508786926, 1e-11);
  EXPECT_NEAR(energy_of(*test::pendulum(), test::orbit_at(trace, 20.0).loop), 2.956677476835926957, 1e-11);
  // The paper's end: both masses within 5 degrees of vertical.
  EXPECT_GT(degrees_from_upright(test::orbit_at(trace, 24.3).loop), 5.0);
  EXPECT_LT(degrees_from_upright(test::orbit_at(trace, 24.7).loop), 5.0);
  EXPECT_LT(degrees_from_upright(trace.last().loop), 2.0);
}

TEST(LongFamilies, OutPhaseToThirty) {
  const test::Trace& trace = family_to_thirty(test::out_phase());
  expect_orbits(trace);
  EXPECT_NEAR(trace.last().energy, 2.999995011170102407, 1e-11);
  EXPECT_LT(degrees_from_upright(trace.last().loop), 5.0);
}

TEST(LongFamilies, SaddleFamiliesToThirty) {
  for (const test::PendulumMode& mode : {test::down_up(), test::up_down()}) {
    const test::Trace& trace = family_to_thirty(mode);
    expect_orbits(trace);
    EXPECT_LT(degrees_from_upright(trace.last().loop), 5.0) << mode.name;
    EXPECT_LT(trace.last().energy, 3.0) << mode.name;
  }
}

}  // namespace
}  // namespace orbweaver::continuation::long_families_test
