// The swinging spring against Newton's law in polar coordinates, and against values that can be worked out by hand.
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/systems/registry.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::swinging_spring_test {
namespace {

/// Accelerations from the Lagrangian in r and th (from the downward vertical),
///   L = mass (r'^2 + r^2 th'^2)/2 - stiffness (r - length)^2/2 + mass gravity r cos th,
/// turned into those of x = r sin th, y = -r cos th.
Eigen::Vector2d accelerations(const std::map<std::string, double>& p, const std::vector<double>& z) {
  using Real = long double;
  const Real r = std::hypot(static_cast<Real>(z[0]), static_cast<Real>(z[1]));
  const Real th = std::atan2(static_cast<Real>(z[0]), -static_cast<Real>(z[1]));
  const Real sine = std::sin(th);
  const Real cosine = std::cos(th);
  const Real r_dot = sine * z[2] - cosine * z[3];
  const Real th_dot = (cosine * z[2] + sine * z[3]) / r;
  const Real r_ddot = r * th_dot * th_dot - p.at("stiffness") / static_cast<Real>(p.at("mass")) * (r - p.at("length")) +
                      p.at("gravity") * cosine;
  const Real th_ddot = (-p.at("gravity") * sine - 2 * r_dot * th_dot) / r;
  const Real inward = r_ddot - r * th_dot * th_dot;
  const Real across = r * th_ddot + 2 * r_dot * th_dot;
  return {static_cast<double>(inward * sine + across * cosine), static_cast<double>(-inward * cosine + across * sine)};
}

TEST(SwingingSpring, FieldFollowsFromTheLagrangianInPolarCoordinates) {
  std::mt19937 generator(17);
  for (int sample = 0; sample < 200; ++sample) {
    const auto parameters = random_parameters(model_info("swinging_spring"), generator);
    const auto system = make_system("swinging_spring", parameters);
    const auto z = random_state(*system, generator);
    const Eigen::Vector2d expected = accelerations(parameters, z);
    std::vector<double> f(4);
    system->field(1, z.data(), f.data());
    EXPECT_EQ(f[0], z[2]);
    EXPECT_EQ(f[1], z[3]);
    const double scale = 1.0 + expected.norm();
    EXPECT_NEAR(f[2], expected[0], 4e-15 * scale);
    EXPECT_NEAR(f[3], expected[1], 4e-15 * scale);
  }
}

TEST(SwingingSpring, EnergyAndActionAreKnownValues) {
  const auto system =
      make_system("swinging_spring", {{"mass", 2.0}, {"stiffness", 8.0}, {"length", 1.5}, {"gravity", 10.0}});
  const std::vector<double> z{1.5, -2.0, 3.0, -4.0};  // r = 2.5, stretched by 1
  EXPECT_DOUBLE_EQ(system->action_density(z), 50.0);
  EXPECT_DOUBLE_EQ(system->conserved(0, z), 25.0 + 4.0 - 40.0);
  ASSERT_EQ(system->structure().guard_names(), std::vector<std::string>{"r"});
  EXPECT_EQ(system->guard(0, z), 2.5);
}

// With stiffness length = 3 mass gravity the spring hangs stretched by a third, and bounces twice as fast as it swings.
TEST(SwingingSpring, IsInResonanceOneToTwo) {
  for (const auto& parameters :
       {std::map<std::string, double>{}, {{"mass", 0.5}, {"stiffness", 6.0}, {"length", 2.0}, {"gravity", 8.0}}}) {
    const auto system = make_system("swinging_spring", parameters);
    const auto& bound = system->parameters();
    ASSERT_EQ(bound.at("stiffness") * bound.at("length"), 3.0 * bound.at("mass") * bound.at("gravity"));
    const double rest = 4.0 / 3.0 * bound.at("length");
    const std::vector<double> z{0.0, -rest, 0.0, 0.0};
    std::vector<double> f(4);
    std::vector<double> jacobian(16);
    system->field_jacobian(1, z.data(), f.data(), jacobian.data());
    const double bounce = bound.at("stiffness") / bound.at("mass");
    const std::vector<double> expected{0, 0, 1, 0, 0, 0, 0, 1, -bounce / 4, 0, 0, 0, 0, -bounce, 0, 0};
    for (const double component : f) EXPECT_NEAR(component, 0.0, 4e-16 * bound.at("gravity"));
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(jacobian[i], expected[i], 1e-14) << "entry " << i;
  }
}

}  // namespace
}  // namespace orbweaver::systems::swinging_spring_test
