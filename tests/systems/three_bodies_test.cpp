// Three bodies against Newton's law for their positions and velocities in a frame that does not turn.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/systems/registry.hpp"
#include "systems/inertial_bodies.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::three_bodies_test {
namespace {

using test::Inertial;
using test::Vector2;

/// The rates of r, x, y, pr, px, py of bodies that move by Newton's law.
std::vector<double> newtons_rates(const Inertial& bodies) {
  const auto a = bodies.accelerations();
  const auto& m = bodies.masses;
  const double pair = m[0] + m[1];
  const Vector2 way = bodies.x[1] - bodies.x[0];
  const Vector2 speed = bodies.v[1] - bodies.v[0];
  const Vector2 change = a[1] - a[0];
  const Vector2 third = bodies.x[2] - (m[0] * bodies.x[0] + m[1] * bodies.x[1]) / pair;
  const Vector2 third_speed = bodies.v[2] - (m[0] * bodies.v[0] + m[1] * bodies.v[1]) / pair;
  const Vector2 third_change = a[2] - (m[0] * a[0] + m[1] * a[1]) / pair;
  const Vector2 e = way.normalized();
  const Vector2 n(-e.y(), e.x());
  const double rate = speed.dot(n) / way.norm();  // e' = rate n, n' = -rate e
  const double k = m[0] * m[1] / pair;
  const double K = m[2] * pair / (pair + m[2]);
  return {speed.dot(e),
          third_speed.dot(e) + rate * third.dot(n),
          third_speed.dot(n) - rate * third.dot(e),
          k * (change.dot(e) + rate * speed.dot(n)),
          K * (third_change.dot(e) + rate * third_speed.dot(n)),
          K * (third_change.dot(n) - rate * third_speed.dot(e))};
}

TEST(ThreeBodies, MoveByNewtonsLaw) {
  std::mt19937 generator(21);
  for (int sample = 0; sample < 200; ++sample) {
    const auto system = make_system("three_bodies", random_parameters(model_info("three_bodies"), generator));
    const auto z = random_state(*system, generator);
    const Inertial bodies = test::inertial(system->parameters(), z, 0.1 * sample);
    const std::vector<double> expected = newtons_rates(bodies);
    std::vector<double> f(6);
    system->field(1, z.data(), f.data());
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(f[i], expected[i], 1e-12 * (1.0 + std::abs(f[i]))) << i;
    EXPECT_NEAR(system->conserved(0, z), bodies.energy(), 1e-12 * (1.0 + std::abs(bodies.energy())));
    EXPECT_NEAR(bodies.angular_momentum(), system->parameters().at("L"), 1e-12);
    EXPECT_LT(bodies.momentum().norm(), 1e-13);
  }
}

TEST(ThreeBodies, GuardsAreTheDistances) {
  std::mt19937 generator(22);
  const auto system = make_system("three_bodies", {{"m1", 2.0}, {"m2", 0.5}});
  const auto z = random_state(*system, generator);
  const Inertial bodies = test::inertial(system->parameters(), z, 0.3);
  ASSERT_EQ(system->structure().guard_names(), (std::vector<std::string>{"r12", "r13", "r23"}));
  EXPECT_NEAR(system->guard(0, z), (bodies.x[0] - bodies.x[1]).norm(), 1e-14);
  EXPECT_NEAR(system->guard(1, z), (bodies.x[0] - bodies.x[2]).norm(), 1e-14);
  EXPECT_NEAR(system->guard(2, z), (bodies.x[1] - bodies.x[2]).norm(), 1e-14);
}

/// Equivariances, then reversors.
std::string symmetries(const std::map<std::string, double>& parameters, const std::string& free = "") {
  FamilyScalars scalars;
  if (!free.empty()) scalars.free = {free};
  const Structure structure = make_system("three_bodies", parameters, {}, scalars)->structure();
  std::string names;
  for (const Symmetry& s : structure.equivariances) names += s.name + " ";
  for (const Symmetry& r : structure.reversors) names += r.name + " ";
  return names;
}

TEST(ThreeBodies, SymmetriesAreThoseOfTheParametersAndOfWhatMoves) {
  const std::map<std::string, double> unequal{{"m1", 2.0}};
  const std::map<std::string, double> turning{{"L", 0.5}};
  EXPECT_EQ(symmetries({}), "Y S SY R RY RS RSY ");
  EXPECT_EQ(symmetries({}, "m3"), "Y S SY R RY RS RSY ");
  EXPECT_EQ(symmetries(unequal), "Y R RY ");
  EXPECT_EQ(symmetries({}, "m1"), "Y R RY ");
  EXPECT_EQ(symmetries({}, "m2"), "Y R RY ");
  EXPECT_EQ(symmetries(turning), "S R RS ");
  EXPECT_EQ(symmetries({}, "L"), "S R RS ");
}

}  // namespace
}  // namespace orbweaver::systems::three_bodies_test
