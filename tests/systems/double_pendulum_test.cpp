// The double pendulum's written-out equations against its Lagrangian, and against values that can be worked out by
// hand.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/systems/registry.hpp"
#include "support/dual_derivatives.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::double_pendulum_test {
namespace {

struct Lagrangian {
  std::map<std::string, double> parameters;

  /// Kinetic minus potential energy of the two bobs, from their Cartesian velocities and heights; z = (q1, q2, w1, w2).
  template <class S>
  S operator()(const S* z) const {
    using std::cos;
    using std::sin;
    const double l1 = parameters.at("l1");
    const double l2 = parameters.at("l2");
    const double m1 = parameters.at("m1");
    const double m2 = parameters.at("m2");
    const S vx1 = l1 * cos(z[0]) * z[2];
    const S vy1 = l1 * sin(z[0]) * z[2];
    const S vx2 = vx1 + l2 * cos(z[1]) * z[3];
    const S vy2 = vy1 + l2 * sin(z[1]) * z[3];
    const S height1 = -l1 * cos(z[0]);
    const S height2 = height1 - l2 * cos(z[1]);
    const S kinetic = 0.5 * m1 * (vx1 * vx1 + vy1 * vy1) + 0.5 * m2 * (vx2 * vx2 + vy2 * vy2);
    return kinetic - parameters.at("g") * (m1 * height1 + m2 * height2);
  }
};

/// Angular accelerations from d/dt dL/dw = dL/dq, that is L_ww w' = L_q - L_wq w, all derivatives taken of L itself.
Eigen::Vector2d accelerations(const Lagrangian& lagrangian, const double* z) {
  const auto as_field = [&]<class S>(const S* state, S* f) {
    f[0] = lagrangian(state);
    for (int i = 1; i < 4; ++i) f[i] = S(0.0);
  };
  const std::array<double, 4> weights{1.0, 0.0, 0.0, 0.0};
  const auto gradient = ad::value_gradient<4>(lagrangian, z).gradient;
  const auto hessian = ad::second_derivatives<4>(as_field, z, weights.data());
  Eigen::Matrix2d mass;
  mass << hessian[10], hessian[11], hessian[14], hessian[15];
  const Eigen::Vector2d force(gradient[0] - hessian[8] * z[2] - hessian[9] * z[3],
                              gradient[1] - hessian[12] * z[2] - hessian[13] * z[3]);
  return mass.inverse() * force;
}

TEST(DoublePendulum, FieldFollowsFromTheLagrangian) {
  std::mt19937 generator(7);
  for (int sample = 0; sample < 200; ++sample) {
    const auto parameters = random_parameters(model_info("double_pendulum"), generator);
    const auto system = make_system("double_pendulum", parameters);
    const auto z = random_numbers(4, generator);
    const Eigen::Vector2d expected = accelerations(Lagrangian{parameters}, z.data());
    std::vector<double> f(4);
    system->field(1, z.data(), f.data());
    EXPECT_EQ(f[0], z[2]);
    EXPECT_EQ(f[1], z[3]);
    const double scale = 1.0 + expected.norm();
    EXPECT_NEAR(f[2], expected[0], 1e-13 * scale);
    EXPECT_NEAR(f[3], expected[1], 1e-13 * scale);
  }
}

TEST(DoublePendulum, EnergyAndActionFollowFromTheLagrangian) {
  std::mt19937 generator(8);
  for (int sample = 0; sample < 50; ++sample) {
    const auto parameters = random_parameters(model_info("double_pendulum"), generator);
    const auto system = make_system("double_pendulum", parameters);
    const auto z = random_numbers(4, generator);
    const auto [value, gradient] = ad::value_gradient<4>(Lagrangian{parameters}, z.data());
    const double momentum_times_velocity = gradient[2] * z[2] + gradient[3] * z[3];
    const double scale = 1.0 + std::abs(value) + std::abs(momentum_times_velocity);
    EXPECT_NEAR(system->action_density(z), momentum_times_velocity, 1e-14 * scale);
    EXPECT_NEAR(system->conserved(0, z), momentum_times_velocity - value, 1e-14 * scale);
  }
}

TEST(DoublePendulum, HangsAtRestWithTheKnownNormalModes) {
  const auto system = make_system("double_pendulum");
  const std::vector<double> z(4, 0.0);
  std::vector<double> f(4);
  std::vector<double> jacobian(16);
  system->field_jacobian(1, z.data(), f.data(), jacobian.data());
  for (const double component : f) EXPECT_EQ(component, 0.0);
  const std::vector<double> expected{0, 0, 1, 0, 0, 0, 0, 1, -2, 1, 0, 0, 2, -2, 0, 0};
  for (std::size_t i = 0; i < 16; ++i) EXPECT_DOUBLE_EQ(jacobian[i], expected[i]) << "entry " << i;
  EXPECT_DOUBLE_EQ(system->conserved(0, z), -3.0);
}

TEST(DoublePendulum, EqualStatesModuloATurnHaveEqualFields) {
  const auto system = make_system("double_pendulum");
  const std::vector<double> z{0.7, -1.9, 0.4, 1.3};
  const std::vector<double> turned{z[0] + 2.0 * std::numbers::pi, z[1] - 4.0 * std::numbers::pi, z[2], z[3]};
  std::vector<double> f(4);
  std::vector<double> g(4);
  system->field(1, z.data(), f.data());
  system->field(1, turned.data(), g.data());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(f[i], g[i], 2e-15 * 4.0);
}

}  // namespace
}  // namespace orbweaver::systems::double_pendulum_test
