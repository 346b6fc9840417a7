// Orbits of amplitude 1e-10, where the period is that of the linear oscillation to 1e-20 and energies are rounding; and
// the way from there to large ones.
#include <cmath>
#include <numbers>

#include "continuation/families.hpp"
#include "hard/hard_case.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace amplitudes_test {
namespace {

using namespace orbweaver;

constexpr double pi = std::numbers::pi;

/// The other frequency of small oscillations at a mode's equilibrium; of a saddle: the rate of growth.
struct Other {
  double rate;
  bool oscillates;
};
Other other_than(const test::PendulumMode& mode) {
  if (mode.name == "In-Phase") return {test::out_phase().frequency, true};
  if (mode.name == "Out-Phase") return {test::in_phase().frequency, true};
  return {mode.frequency, false};  // M w^2 v = G v has w^2 = +-sqrt 2
}

class Amplitudes : public testing::TestWithParam<test::PendulumMode> {};

TEST_P(Amplitudes, OfOneInTenThousandMillion) {
  const test::PendulumMode& mode = GetParam();
  // About (0, 0) a state is known to 1e-16 of itself, elsewhere to 1e-16 of pi.
  const bool at_zero = mode.point[0] == 0.0 && mode.point[1] == 0.0;
  const std::string name = mode.name + ", amplitude 1e-10";
  continuation::Options options;
  options.start_amplitude = 1e-10;
  options.step_limit = 1;
  test::HardCase row(name, "T of the linear mode, relative");
  const test::Trace trace = test::trace_of(mode, options);
  ASSERT_FALSE(trace.orbits.empty()) << trace.ending.text();
  const loop::Loop& orbit = trace.last().loop;
  row.within(std::abs(orbit.period / mode.period() - 1.0), at_zero ? 1e-12 : 1e-5);
  const std::vector<double> z = loop::state_at(orbit, 0.0);
  const double first = z[0] - mode.point[0];
  const double second = z[1] - mode.point[1];
  test::HardCase(name, "th2/th1 of the linear mode, relative")
      .within(std::abs(second / first / mode.ratio - 1.0), at_zero ? 1e-12 : 1e-5);
  EXPECT_NEAR(std::hypot(first, second), 1e-10, 1e-14);
  // Half a period: P = -M(T/2).
  const spectrum::Stability stability =
      spectrum::floquet(*test::pendulum(), orbit, test::pendulum_isotropy(*test::pendulum()));
  const Other other = other_than(mode);
  const double angle = 0.5 * other.rate * mode.period();
  const double index = -2.0 * (other.oscillates ? std::cos(angle) : std::cosh(angle));
  test::HardCase(name, "index of the linear flow")
      .within(std::abs(stability.fundamental.at(0).real() - index), at_zero ? 1e-9 : 1e-4 * std::abs(index));
  test::HardCase(name, "its own bound, in parts of it")
      .within(std::abs(stability.fundamental.at(0).real() - index) / stability.fundamental_error.at(0), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Hard, Amplitudes, testing::ValuesIn(test::pendulum_modes()));

// About pi a state is known to 4e-16, hence a loop of amplitude A to 4e-16/A of itself.
TEST(Amplitudes, NearRounding) {
  for (const double amplitude : {1e-11, 1e-12, 1e-13}) {
    continuation::Options options;
    options.start_amplitude = amplitude;
    options.step_limit = 1;
    test::HardCase row(fmt::format("Down-Up, amplitude {:.0e}", amplitude), "T of the linear mode, relative");
    const test::Trace trace = test::trace_of(test::down_up(), options);
    ASSERT_FALSE(trace.orbits.empty()) << trace.ending.text();
    row.within(std::abs(trace.last().loop.period / test::down_up().period() - 1.0), 4e-15 / amplitude);
  }
}

// Nearer than rounding allows the first orbit is taken further out, where T is known to a hundredth; and however far
// out, it says what tolerance it meets.
TEST(Amplitudes, BelowRounding) {
  for (const auto method : {corrector::Method::automatic, corrector::Method::nls})
    for (const double amplitude : {1e-12, 1e-14, 1e-16}) {
      continuation::Options options;
      options.corrector.method = method;
      options.start_amplitude = amplitude;
      options.step_limit = 1;
      test::HardCase row(fmt::format("Down-Up, start {:.0e}, {}", amplitude, corrector::name_of(method)),
                         "T of the linear mode, relative");
      const test::Trace trace = test::trace_of(test::down_up(), options);
      ASSERT_FALSE(trace.orbits.empty()) << trace.ending.text();
      const continuation::Orbit& orbit = trace.last();
      row.within(std::abs(orbit.loop.period / test::down_up().period() - 1.0), corrector::largest_unknown);
      const std::vector<double> z = loop::state_at(orbit.loop, 0.0);
      const double reached = std::hypot(z[0], z[1] - pi);
      EXPECT_GT(orbit.moved_out, 1.0);
      EXPECT_NEAR(reached / amplitude, orbit.moved_out, 0.1 * orbit.moved_out);
      EXPECT_LT(reached, 1e-11) << "no further than need be";
      EXPECT_GT(orbit.tolerance_met, 1e-3);
      EXPECT_LT(orbit.tolerance_met, corrector::largest_unknown);
    }
  continuation::Options options;
  options.start_amplitude = 1e-16;  // about 0 nothing is lost
  options.step_limit = 1;
  const test::Trace trace = test::trace_of(test::in_phase(), options);
  ASSERT_FALSE(trace.orbits.empty()) << trace.ending.text();
  EXPECT_EQ(trace.last().moved_out, 0.0);
  EXPECT_EQ(trace.last().tolerance_met, 0.0);
  EXPECT_NEAR(trace.last().loop.period, test::in_phase().period(), 1e-12);
}

// 30 digits of the orbit with T = 9 that `orbweaver refine` gives; by an extrapolation method in Python (mpmath), from
// the Lagrangian, both angles are zero at T/4 to 2e-30.
TEST(Amplitudes, ToALargeOne) {
  continuation::Options options;
  options.start_amplitude = 1e-10;
  options.period_limit = 9.0;
  test::HardCase row("In-Phase from amplitude 1e-10 to T = 9", "th1(0), 30 digits by mpmath");
  const test::Trace trace = test::trace_of(test::in_phase(), options);
  ASSERT_EQ(trace.ending.reason, continuation::EndReason::period_limit) << trace.ending.text();
  row.within(std::abs(loop::state_at(trace.last().loop, 0.0)[0] - 1.36031242236649898365631514599), 1e-12);
  test::HardCase("In-Phase from amplitude 1e-10 to T = 9", "energy, 30 digits by mpmath")
      .within(std::abs(trace.last().energy + 0.764030789927984606850110349553), 1e-12);
}

}  // namespace
}  // namespace amplitudes_test
