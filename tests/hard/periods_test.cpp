// Periods to 1000. Beyond T of about 80 the energy is that of the saddle to rounding: what is judged is the loss, the
// closure, and how near the orbit comes to the connection of the saddle, which it has to follow.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bifurcation/crossings.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/bifurcation/directions.hpp"

namespace periods_test {
namespace {

using namespace orbweaver;
using test::reference::Point;
using test::reference::Real;

constexpr double longest = 1000.0;
const test::reference::DoublePendulum pendulum_law;

/// The largest gap between the loop and an integration over each of `segments` equal parts of the period.
template <class Law>
double closure_by(const Law& law, const loop::Loop& loop, int segments) {
  double largest = 0.0;
  for (int n = 0; n < segments; ++n) {
    const double from = loop.period * n / segments;
    const double to = loop.period * (n + 1) / segments;
    const auto here = test::reference::point_of<4>(loop::state_at(loop, from));
    const auto there = test::reference::point_of<4>(loop::state_at(loop, to));
    const Point<4> reached = test::reference::flow(law, here, Real(to) - Real(from));
    largest = test::worse(largest, static_cast<double>(test::reference::distance(reached, there)));
  }
  return largest;
}

/// The velocities with which the orbit of energy 3 through the angles of `state` that ends on the upright saddle
/// leaves, by bisection of their direction near that of `state`: on either side of it orbits fall to other sides of the
/// saddle.
Point<4> connection_near(const Point<4>& state) {
  const Real twice_kinetic = 2 * (3 + 2 * std::cos(state[0]) + std::cos(state[1]));
  const auto start = [&](Real angle) {
    const Real c = std::cos(state[0] - state[1]);
    const Real a = std::cos(angle);
    const Real b = std::sin(angle);
    const Real size = std::sqrt(twice_kinetic / (2 * a * a + b * b + 2 * a * b * c));
    return Point<4>{state[0], state[1], size * a, size * b};
  };
  const auto side = [&](Real angle) {
    bool came_near = false;
    Real fell = 0;
    (void)test::reference::flow(pendulum_law, start(angle), Real(200), 1e-17L, [&](Real, const Point<4>& z) {
      const Real first = std::remainder(z[0] - test::reference::pi, 2 * test::reference::pi);
      const Real second = std::remainder(z[1] - test::reference::pi, 2 * test::reference::pi);
      const Real away = std::max(std::abs(first), std::abs(second));
      came_near = came_near || away < 0.1L;
      fell = std::abs(first) > std::abs(second) ? first : second;
      return !came_near || away < 0.3L;
    });
    return fell;
  };
  const Real angle = std::atan2(state[3], state[2]);
  return start(test::reference::zero_between(side, angle - 1e-8L, angle + 1e-8L));
}

void expect_to_longest(const test::PendulumMode& mode) {
  continuation::Options options;
  options.period_limit = longest;
  test::HardCase row(mode.name + " to T = 1000", "a family that diverges has an orbit of every period");
  const test::Trace trace = test::trace_of(mode, options);
  row.is(trace.ending.reason == continuation::EndReason::period_limit, "period limit (T = 1000)", trace.ending.text());
  ASSERT_FALSE(trace.orbits.empty());
  double loss = 0.0;
  double action = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits) {
    loss = test::worse(loss, orbit.loss_rms);
    if (orbit.loop.period > 100.0) action = test::worse(action, std::abs(orbit.action - trace.last().action));
  }
  test::HardCase(mode.name + " to T = 1000", "sqrt(loss), all orbits").within(loss, 1e-10);
  test::HardCase(mode.name + " to T = 1000", "dW = T dE = 0 from T = 100 on").within(action, 1e-9);
  const loop::Loop& last = trace.last().loop;
  test::HardCase(mode.name + ", T = 1000", "closes by extrapolation, 1000 parts")
      .within(closure_by(pendulum_law, last, 1000), 1e-9);
  // Angles at T/4 are whole multiples of pi by symmetry.
  Point<4> quarter = test::reference::point_of<4>(loop::state_at(last, last.period / 4.0));
  double off = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Real whole = std::nearbyint(quarter[i] / test::reference::pi) * test::reference::pi;
    off = test::worse(off, static_cast<double>(std::abs(quarter[i] - whole)));
    quarter[i] = whole;
  }
  test::HardCase connection(mode.name + ", T = 1000", "the upright saddle's connection, by bisection");
  connection.within(test::worse(off, static_cast<double>(test::reference::distance(quarter, connection_near(quarter)))),
                    1e-9);
}

TEST(Periods, DownUp) { expect_to_longest(test::down_up()); }
TEST(Periods, InPhase) { expect_to_longest(test::in_phase()); }
TEST(Periods, OutPhase) { expect_to_longest(test::out_phase()); }
TEST(Periods, UpDown) { expect_to_longest(test::up_down()); }

// y'' = y^2 - y: at E = 1/6 y = 1 - 3/2 sech(t/2)^2. Orbits of this family are as near to it as their period is long.
TEST(Periods, StraightOrbitsOfHenonAndHeiles) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<double> origin(4, 0.0);
  const starts::SweepResult swept = starts::sweep(*system, origin, {.period_from = 6.0, .period_to = 6.5, .step = 0.5});
  ASSERT_EQ(swept.degenerate.size(), 1U);
  const auto found = bifurcation::equilibrium_directions(*system, origin, swept.degenerate[0], 10).found;
  ASSERT_FALSE(found.empty());
  continuation::Options options;
  options.period_limit = longest;
  test::HardCase row("Straight, Henon-Heiles, to T = 1000", "a family that diverges has an orbit of every period");
  const test::Trace trace = test::trace_of(system, {found[0].base, found[0].tangent, found[0].isotropy}, options);
  row.is(trace.ending.reason == continuation::EndReason::period_limit, "period limit (T = 1000)", trace.ending.text());
  ASSERT_FALSE(trace.orbits.empty());
  const loop::Loop& last = trace.last().loop;
  // The bottom is at one of the ends of the half period.
  const double bottom =
      loop::state_at(last, 0.0)[1] < loop::state_at(last, 0.5 * last.period)[1] ? 0.0 : 0.5 * last.period;
  double off = 0.0;
  for (int n = -400; n <= 400; ++n) {
    const double t = 0.1 * n;
    const double y = 1.0 - 1.5 / std::pow(std::cosh(0.5 * t), 2);
    const std::vector<double> z = loop::state_at(last, bottom + t);
    off = test::worse(off, std::hypot(z[0], z[1] - y));
  }
  test::HardCase("Straight, Henon-Heiles, T = 1000", "the separatrix 1 - 3/2 sech(t/2)^2").within(off, 1e-9);
}

}  // namespace
}  // namespace periods_test
