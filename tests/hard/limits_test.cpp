// What cannot be had: a cutoff that is too small, tolerances below rounding. The end is clear, nothing climbs to
// K = 4096, and every orbit that is kept is right.
#include <cmath>
#include <limits>
#include <numbers>

#include "continuation/families.hpp"
#include "hard/hard_case.hpp"
#include "hard/plane_pendulum.hpp"
#include "hard/reference.hpp"
#include "spectrum/point_systems.hpp"

namespace limits_test {
namespace {

using namespace orbweaver;

test::Trace swings(continuation::Options options) {
  return test::trace_of(std::make_shared<const test::PlanePendulum>(),
                        {loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, 8),
                         {test::PlanePendulum::small_oscillation().modes},
                         test::PlanePendulum::isotropy()},
                        options);
}

/// The largest relative error of T against the exact one at the orbit's reach.
double worst_period(const test::Trace& trace) {
  double worst = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits) {
    const long double reach = std::abs(loop::state_at(orbit.loop, 0.0)[0]);
    const auto exact = static_cast<double>(4 * test::reference::pendulum_quarter(test::reference::pi - reach));
    worst = test::worse(worst, std::abs(orbit.loop.period / exact - 1.0));
  }
  return worst;
}

int most_harmonics(const test::Trace& trace) {
  int most = 0;
  for (const continuation::Orbit& orbit : trace.orbits) most = std::max(most, orbit.loop.cutoff);
  return most;
}

// Harmonics of the pendulum's orbit fall like exp(-pi k K'/2K), K and K' being complete elliptic integrals: how many
// are above 1e-12 follows from its reach.
TEST(Limits, ACutoffThatIsTooSmall) {
  for (const int cutoff : {15, 31, 100}) {
    const std::string name = fmt::format("pendulum, at most K = {}", cutoff);
    continuation::Options options;
    options.cutoff_to = cutoff;
    options.fit_time_map = false;
    test::HardCase row(name, "orbits need more and more harmonics");
    const test::Trace trace = swings(options);
    row.is((trace.ending.reason == continuation::EndReason::cutoff_limit ||
            trace.ending.reason == continuation::EndReason::period_divergence) &&
               most_harmonics(trace) <= cutoff,
           "cutoff limit or period divergence", trace.ending.text());
    ASSERT_FALSE(trace.orbits.empty());
    test::HardCase(name, "T(amplitude) by elliptic integrals, all orbits, relative").within(worst_period(trace), 1e-10);
    // K'(m)/K(m) = agm(1, cos(A/2))/agm(1, sin(A/2)) at the reach A of the last orbit.
    const long double reach = std::abs(loop::state_at(trace.last().loop, 0.0)[0]);
    const long double ratio =
        test::reference::pendulum_quarter(reach) / test::reference::pendulum_quarter(test::reference::pi - reach);
    const double needed = static_cast<double>(2.0L * std::log(1e12L) / (test::reference::pi * ratio));
    test::HardCase(name, "K that 1e-12 takes at the last orbit: octaves from the limit")
        .within(std::abs(std::log2(needed / cutoff)), 1.0);
  }
}

TEST(Limits, ATooSmallCutoffOfTheDoublePendulum) {
  continuation::Options options;
  options.cutoff_to = 31;
  test::HardCase row("In-Phase to T = 9, at most K = 31", "that orbit needs 87");
  const test::Trace trace = test::trace_of(test::in_phase(), options);
  row.is(trace.ending.reason == continuation::EndReason::cutoff_limit, "cutoff limit", trace.ending.text());
}

/// q'' = -sign(q), whose orbits have T = 4 sqrt(2 A) and harmonics that fall like 1/k^3: no K is enough for 1e-10.
class Jump final : public test::PointSystem {
 public:
  Jump() : PointSystem(test::PlanePendulum().structure()) {}
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(z[1], z[0] > 0.0 ? -1.0 : z[0] < 0.0 ? 1.0 : 0.0);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd&) const override {
    Eigen::Matrix2d a;
    a << 0.0, 1.0, 0.0, 0.0;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(z[0] > 0.0 ? 1.0 : -1.0, z[1]);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * z[1] * z[1] + std::abs(z[0]);
  }
};

TEST(Limits, AFieldThatJumps) {
  const auto system = std::make_shared<const Jump>();
  // q from 1 down to -1 and back: q = 1 - t^2/2 in the first quarter.
  constexpr int cutoff = 40;
  loop::Loop base = loop::constant_loop(std::vector<double>(2, 0.0), 4.0 * std::sqrt(2.0), cutoff);
  const double omega = 2.0 * std::numbers::pi / base.period;
  for (int k = 1; k <= cutoff; k += 2) {
    const double p = (k % 4 == 1 ? 1.0 : -1.0) * 4.0 / (std::numbers::pi * k * k * k * omega * omega);
    base.cosine(k, 0) = p;
    base.sine(k, 1) = -p * k * omega;
  }
  loop::Tangent direction{base.modes, {0.5 * base.period}};
  continuation::Options options;
  options.start_amplitude = 0.01;
  options.energy_to = 2.0;
  test::HardCase row("q'' = -sign(q)", "no K is enough: no orbit, or T = 4 sqrt(2 A)");
  const test::Trace trace = test::trace_of(system, {base, direction, test::PlanePendulum::isotropy()}, options);
  double worst = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits) {
    const double reach = std::abs(loop::state_at(orbit.loop, 0.0)[0]);
    worst = test::worse(worst, std::abs(orbit.loop.period / (4.0 * std::sqrt(2.0 * reach)) - 1.0));
  }
  row.within(worst, 1e-8);
  test::HardCase("q'' = -sign(q)", "an end that is said")
      .is(trace.orbits.size() < 10 && !trace.ending.text().empty(), "a reason", trace.ending.text());
}

class Tolerances : public testing::TestWithParam<double> {};

TEST_P(Tolerances, BelowRounding) {
  const double tolerance = GetParam();
  const std::string name = fmt::format("pendulum to T = 30, tolerance {:.0e}", tolerance);
  continuation::Options usual;
  usual.period_limit = 30.0;
  static const int enough = most_harmonics(swings(usual));
  continuation::Options options = usual;
  options.corrector.tolerance = tolerance;
  test::HardCase row(name, "rounding allows no less: the orbits are kept, or a clear failure");
  const test::Trace trace = swings(options);
  row.is((trace.ending.reason == continuation::EndReason::period_limit ||
          (trace.ending.failed() && !trace.ending.text().empty())),
         "period limit or failure", trace.ending.text());
  test::HardCase(name, fmt::format("K in parts of that at 1e-10, {}", enough))
      .within(static_cast<double>(most_harmonics(trace)) / enough, 4.0);
  ASSERT_FALSE(trace.orbits.empty());
  // dT/dA grows like exp(T/4) beside the separatrix: what is compared is the reach.
  double worst = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits) {
    const long double reach = test::reference::pi - test::reference::pendulum_gap(orbit.loop.period);
    if (orbit.loop.period > 6.3)
      worst = test::worse(worst, std::abs(static_cast<double>(reach - std::abs(loop::state_at(orbit.loop, 0.0)[0]))));
  }
  test::HardCase(name, "amplitude(T) by elliptic integrals, all orbits").within(worst, 1e-12);
  double largest = 0.0;
  for (const continuation::Orbit& orbit : trace.orbits) largest = test::worse(largest, orbit.tolerance_met);
  if (tolerance < 3e-14)
    test::HardCase(name, "the tolerance that was met is said")
        .is(largest > tolerance, "more", fmt::format("{:.1e}", largest));
}

INSTANTIATE_TEST_SUITE_P(Hard, Tolerances, testing::Values(1e-13, 1e-14, 1e-16, 1e-20));

}  // namespace
}  // namespace limits_test
