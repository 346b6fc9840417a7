// Loops that an equivariance maps to themselves point by point: rounding leaves something beside that symmetry, which
// no correction sees.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::continuation::kept_symmetries_test {
namespace {

constexpr double coupling = 0.1;
/// The second angle's unit, so that rounding tells the two apart.
constexpr double unit = 1.0 / 3.0;

/// q1'' = -sin q1 - c (q1 - q2), and the other way round; state q1, u, p1, p with q2 = u/3, p2 = 3 p. Where both swing
/// alike each is a pendulum alone.
class TwoPendulums final : public test::PointSystem {
 public:
  TwoPendulums() : PointSystem(described()) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::VectorXd g = gradient_at(z);
    return Eigen::Vector4d(g[2], g[3], -g[0], -g[1]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 2) = 1.0;
    a(1, 3) = 1.0 / (unit * unit);
    a.bottomLeftCorner<2, 2>() << -std::cos(z[0]) - coupling, unit * coupling, unit * coupling,
        -unit * unit * (std::cos(unit * z[1]) + coupling);
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    const double pull = coupling * (z[0] - unit * z[1]);
    return Eigen::Vector4d(std::sin(z[0]) + pull, unit * (std::sin(unit * z[1]) - pull), z[2], z[3] / (unit * unit));
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[2] * z[2] + std::pow(z[3] / unit, 2) + coupling * std::pow(z[0] - unit * z[1], 2)) -
           std::cos(z[0]) - std::cos(unit * z[1]);
  }

  /// q1 = q2 = cos t.
  [[nodiscard]] static loop::Loop swinging_alike() {
    loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * std::numbers::pi, 8);
    loop.cosine(1, 0) = 1.0;
    loop.cosine(1, 1) = 1.0 / unit;
    loop.sine(1, 2) = -1.0;
    loop.sine(1, 3) = -unit;
    return loop;
  }
  static systems::Structure described() {
    systems::Structure d = test::structure_of(4, true, true);
    Eigen::Matrix4d exchange = Eigen::Matrix4d::Zero();
    exchange(0, 1) = exchange(3, 2) = unit;
    exchange(1, 0) = exchange(2, 3) = 1.0 / unit;
    d.equivariances = {{"X", exchange}, {"S", -Eigen::Matrix4d::Identity()}};
    d.reversors = {{"R", Eigen::Matrix4d(Eigen::Vector4d(1, 1, -1, -1).asDiagonal())}};
    return d;
  }
};

/// From rest at an angle: 2 pi over the arithmetic-geometric mean of 1 and cos(angle/2).
double pendulum_period(double angle) {
  double a = 1.0;
  double b = std::cos(0.5 * angle);
  while (std::abs(a - b) > 1e-16 * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    if (mean == a) break;
    a = mean;
  }
  return 2.0 * std::numbers::pi / a;
}

class KeptSymmetries : public testing::TestWithParam<corrector::Method> {};

TEST_P(KeptSymmetries, AreNotLeftByExtrapolation) {
  const auto system = std::make_shared<const TwoPendulums>();
  Start start;
  const loop::Loop oscillation = TwoPendulums::swinging_alike();
  start.base = loop::constant_loop(std::vector<double>(4, 0.0), oscillation.period, oscillation.cutoff);
  start.direction.modes = oscillation.modes;
  start.isotropy = loop::find_isotropy(TwoPendulums::described(), oscillation, 1e-9);
  Options options{.period_limit = 16.0};
  options.corrector.method = GetParam();
  const test::Trace trace = test::trace_of(system, start, options);
  ASSERT_EQ(trace.ending.reason, EndReason::period_limit) << trace.ending.text();
  for (const Orbit& orbit : trace.orbits) {
    const std::vector<double> state = loop::state_at(orbit.loop, 0.0);
    EXPECT_NEAR(state[0], unit * state[1], 1e-14) << orbit.loop.period;
    EXPECT_NEAR(orbit.loop.period, pendulum_period(state[0]), 1e-9 * orbit.loop.period / std::cos(0.5 * state[0]));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, KeptSymmetries,
                         testing::Values(corrector::Method::collocation, corrector::Method::newton_krylov),
                         [](const auto& method) {
                           return method.param == corrector::Method::collocation ? "Collocation" : "WholeLoops";
                         });

}  // namespace
}  // namespace orbweaver::continuation::kept_symmetries_test
