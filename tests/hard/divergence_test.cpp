// Starts on the divergence of the period: an orbit of the pendulum q'' = -sin q with T = 60, 1e-6 rad from upright,
// where its state at rest hardly says what T is.
#include <cmath>
#include <numbers>

#include "continuation/families.hpp"
#include "hard/hard_case.hpp"
#include "hard/plane_pendulum.hpp"
#include "hard/reference.hpp"

namespace divergence_test {
namespace {

using namespace orbweaver;

using test::reference::Point;
using test::reference::Real;

/// Where the orbit with this period is at rest.
Real reach_of(Real period) { return test::reference::pi - test::reference::pendulum_gap(period); }

/// The orbit with this period as a loop: integrated by extrapolation, and its Fourier coefficients summed.
loop::Loop exact_loop(double period, int cutoff) {
  const int nodes = 4 * cutoff;
  const auto law = [](const Point<2>& z) { return Point<2>{z[1], -std::sin(z[0])}; };
  std::vector<Point<2>> states{{reach_of(period), 0}};
  for (int n = 1; n <= nodes / 4; ++n)
    states.push_back(test::reference::flow(law, states.back(), Real(period) / nodes));
  // The rest by its symmetries: q(T/2 - t) = -q(t), p(T/2 - t) = p(t).
  const auto state = [&](int n) -> Point<2> {
    n %= nodes;
    const Real turned = n > nodes / 2 ? -1 : 1;
    const int m = n > nodes / 2 ? nodes - n : n;  // q even, p odd
    const Point<2> z = m <= nodes / 4 ? states[static_cast<std::size_t>(m)]
                                      : Point<2>{-states[static_cast<std::size_t>(nodes / 2 - m)][0],
                                                 states[static_cast<std::size_t>(nodes / 2 - m)][1]};
    return {z[0], turned * z[1]};
  };
  loop::Loop loop = loop::constant_loop(std::vector<double>(2, 0.0), period, cutoff);
  for (int k = 1; k <= cutoff; k += 2) {
    Real q = 0;
    Real p = 0;
    for (int n = 0; n < nodes; ++n) {
      const Real angle = 2 * test::reference::pi * k * n / nodes;
      q += state(n)[0] * std::cos(angle);
      p += state(n)[1] * std::sin(angle);
    }
    loop.cosine(k, 0) = static_cast<double>(2 * q / nodes);
    loop.sine(k, 1) = static_cast<double>(2 * p / nodes);
  }
  return loop;
}

test::Trace from_divergence(double period, double towards, continuation::Options options) {
  const auto system = std::make_shared<const test::PlanePendulum>();
  constexpr int cutoff = 250;
  const loop::Loop base = exact_loop(period, cutoff);
  const loop::Loop next = exact_loop(towards, cutoff);
  loop::Tangent direction{next.modes, {towards - period}};
  for (std::size_t n = 0; n < direction.modes.size(); ++n) direction.modes[n] -= base.modes[n];
  return test::trace_of(system, {base, direction, test::PlanePendulum::isotropy()}, options);
}

/// The largest |q(0) - reach(T)| over the orbits.
double worst_reach(const test::Trace& trace) {
  double worst = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits)
    if (orbit.loop.period > 6.3)
      worst = test::worse(worst, static_cast<double>(std::abs(reach_of(orbit.loop.period) -
                                                              std::abs(loop::state_at(orbit.loop, 0.0)[0]))));
  return worst;
}

class Divergence : public testing::TestWithParam<double> {};

TEST_P(Divergence, Outwards) {
  const double period = GetParam();
  const std::string name = fmt::format("pendulum from T = {} to 200", period);
  continuation::Options options;
  options.period_limit = 200.0;
  options.start_amplitude = 1e-7;
  test::HardCase row(name, "there is an orbit of every period");
  const test::Trace trace = from_divergence(period, period + 1.0, options);
  row.is(trace.ending.reason == continuation::EndReason::period_limit, "period limit (T = 200)", trace.ending.text());
  test::HardCase(name, "amplitude(T) by elliptic integrals, all orbits").within(worst_reach(trace), 1e-10);
}

TEST_P(Divergence, Inwards) {
  const double period = GetParam();
  const std::string name = fmt::format("pendulum from T = {} inwards", period);
  continuation::Options options;
  options.start_amplitude = 1e-7;
  test::HardCase row(name, "it shrinks to the equilibrium");
  const test::Trace trace = from_divergence(period, period - 1.0, options);
  row.is(trace.ending.reason == continuation::EndReason::fixed_point, "arrived at a fixed point", trace.ending.text());
  test::HardCase(name, "amplitude(T) by elliptic integrals, all orbits").within(worst_reach(trace), 1e-10);
  ASSERT_FALSE(trace.orbits.empty());
  test::HardCase(name, "T = 2 pi at its end").within(std::abs(trace.last().loop.period - 2.0 * std::numbers::pi), 1e-3);
}

// A first step of 0.0087 rad at rest would have to pass the separatrix: none is taken, or a right one.
TEST_P(Divergence, TheUsualFirstStep) {
  const double period = GetParam();
  const std::string name = fmt::format("pendulum from T = {}, first step 0.0087", period);
  continuation::Options options;
  options.period_limit = 200.0;
  test::HardCase row(name, "amplitude(T) by elliptic integrals, all orbits");
  const test::Trace trace = from_divergence(period, period + 1.0, options);
  row.within(worst_reach(trace), 1e-10);
  test::HardCase(name, "an end that is said")
      .is(!trace.ending.text().empty(), "a limit or a reason", trace.ending.text());
}

INSTANTIATE_TEST_SUITE_P(Hard, Divergence, testing::Values(30.0, 60.0));

}  // namespace
}  // namespace divergence_test
