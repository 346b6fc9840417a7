// The planar restricted three-body problem against Hamilton's equations in canonical momenta, and against known values.
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::pcr3bp_test {
namespace {

using Real = long double;

constexpr double earth_moon = 0.01215058560962404;

/// H(x, y, px, py) in the frame that turns, from the inertial energy less the angular momentum.
Real hamiltonian(Real mu, const std::array<Real, 4>& q) {
  const Real kinetic = (q[2] * q[2] + q[3] * q[3]) / 2;
  const Real angular_momentum = q[0] * q[3] - q[1] * q[2];
  return kinetic - angular_momentum - (1 - mu) / std::hypot(q[0] + mu, q[1]) - mu / std::hypot(q[0] - 1 + mu, q[1]);
}

/// dH/dq_i by central differences of order eight: wrong by some 1e-15 where the bodies are 0.5 away.
Real derivative(Real mu, const std::array<Real, 4>& q, std::size_t i) {
  constexpr Real h = 1.0L / 1024;
  constexpr std::array<Real, 4> stencil{4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280};
  Real sum = 0;
  for (std::size_t k = 0; k < stencil.size(); ++k) {
    std::array<Real, 4> above = q;
    std::array<Real, 4> below = q;
    above[i] += h * static_cast<Real>(k + 1);
    below[i] -= h * static_cast<Real>(k + 1);
    sum += stencil[k] / h * (hamiltonian(mu, above) - hamiltonian(mu, below));
  }
  return sum;
}

std::array<Real, 4> canonical(const std::vector<double>& z) {
  return {z[0], z[1], static_cast<Real>(z[2]) - z[1], static_cast<Real>(z[3]) + z[0]};
}

TEST(Pcr3bp, FieldIsHamiltonsEquations) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> masses(1e-3, 0.5);
  for (int sample = 0; sample < 200; ++sample) {
    const double mu = masses(generator);
    const auto system = make_system("pcr3bp", {{"mu", mu}});
    const auto z = random_state(*system, generator);
    const std::array<Real, 4> q = canonical(z);
    const Real vx = derivative(mu, q, 2);
    const Real vy = derivative(mu, q, 3);
    const Real px_dot = -derivative(mu, q, 0);
    const Real py_dot = -derivative(mu, q, 1);
    const std::array<Real, 4> expected{vx, vy, px_dot + vy, py_dot - vx};  // vx = px + y, vy = py - x
    std::vector<double> f(4);
    system->field(1, z.data(), f.data());
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(f[i], static_cast<double>(expected[i]),
                  4e-15 * (1.0 + std::abs(f[i]) + std::abs(z[2]) + std::abs(z[3])))
          << i;
  }
}

TEST(Pcr3bp, EnergyAndActionAreThoseOfTheMomenta) {
  std::mt19937 generator(12);
  for (int sample = 0; sample < 50; ++sample) {
    const auto parameters = random_parameters(model_info("pcr3bp"), generator);
    const auto system = make_system("pcr3bp", parameters);
    const auto z = random_state(*system, generator);
    const std::array<Real, 4> q = canonical(z);
    const auto energy = static_cast<double>(hamiltonian(parameters.at("mu"), q));
    const auto action = static_cast<double>(q[2] * z[2] + q[3] * z[3]);
    EXPECT_NEAR(system->conserved(0, z), energy, 1e-14 * (1.0 + std::abs(energy)));
    EXPECT_NEAR(system->action_density(z), action, 1e-14 * (1.0 + std::abs(action)));
  }
}

TEST(Pcr3bp, GuardsAreTheDistancesToTheBodies) {
  const auto system = make_system("pcr3bp", {{"mu", 0.25}});
  ASSERT_EQ(system->structure().guard_names(), (std::vector<std::string>{"r1", "r2"}));
  const std::vector<double> z{-0.25 + 0.375, 0.5, 7.0, -7.0};
  EXPECT_EQ(system->guard(0, z), 0.625);
  EXPECT_EQ(system->guard(1, {std::vector<double>{0.75 - 1.5, 2.0, 1.0, 1.0}}), 2.5);
}

struct Point {
  double x;
  double y;
  double jacobi;  ///< -2 H
};

/// Newton's method from a start with three digits.
std::vector<double> equilibrium(const System& system, const Point& near) {
  const auto three_digits = [](double value) { return std::round(1e3 * value) / 1e3; };
  std::vector<double> z{three_digits(near.x), three_digits(near.y), 0.0, 0.0};
  Eigen::Vector4d f;
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> jacobian;
  for (int step = 0; step < 8; ++step) {
    system.field_jacobian(1, z.data(), f.data(), jacobian.data());
    Eigen::Map<Eigen::Vector4d>(z.data()) -= jacobian.inverse() * f;
  }
  return z;
}

void expect_lagrange_points(double mu, const std::array<Point, 5>& points) {
  const auto system = make_system("pcr3bp", {{"mu", mu}});
  for (std::size_t n = 0; n < points.size(); ++n) {
    SCOPED_TRACE(n + 1);
    const std::vector<double> z = equilibrium(*system, points[n]);
    EXPECT_NEAR(z[0], points[n].x, 1e-14);
    EXPECT_NEAR(z[1], points[n].y, 1e-14);
    EXPECT_EQ(z[2], 0.0);
    EXPECT_EQ(z[3], 0.0);
    EXPECT_NEAR(-2.0 * system->conserved(0, z), points[n].jacobi, 1e-14);
  }
}

// Roots of Euler's quintics and Jacobi constants in 40 digits; L4 and L5 close equilateral triangles.
TEST(Pcr3bp, LagrangePointsOfEarthAndMoon) {
  expect_lagrange_points(earth_moon, {{{0.83691512577235715454, 0.0, 3.1883411177492399483},
                                       {1.155682165444884122, 0.0, 3.1721604609685273832},
                                       {-1.005062645810277843, 0.0, 3.0121471506805043017},
                                       {0.48784941439037596, 0.86602540378443864676, 2.9879970511210327628},
                                       {0.48784941439037596, -0.86602540378443864676, 2.9879970511210327628}}});
}

TEST(Pcr3bp, LagrangePointsOfASmallMass) {
  // L4 and L5 lie in a valley of slope 27/4 mu: rounding leaves them 10 times less certain than above.
  const auto system = make_system("pcr3bp", {{"mu", 0.001}});
  const std::array<Point, 3> collinear{{{0.93128697550186087306, 0.0, 3.0399487749745889953},
                                        {1.0699160979882243073, 0.0, 3.0386151746514519628},
                                        {-1.0004166666122850178, 0.0, 3.0009999789680306061}}};
  for (const Point& point : collinear) {
    const std::vector<double> z = equilibrium(*system, point);
    EXPECT_NEAR(z[0], point.x, 1e-14);
    EXPECT_EQ(z[1], 0.0);
    EXPECT_NEAR(-2.0 * system->conserved(0, z), point.jacobi, 1e-14);
  }
  const std::vector<double> l4 = equilibrium(*system, {0.499, 0.86602540378443864676, 0.0});
  EXPECT_NEAR(l4[0], 0.499, 1e-13);
  EXPECT_NEAR(l4[1], 0.86602540378443864676, 1e-13);
  EXPECT_NEAR(-2.0 * system->conserved(0, l4), 2.999001, 1e-14);
}

std::vector<std::string> names_of(const std::vector<Symmetry>& symmetries) {
  std::vector<std::string> names;
  for (const Symmetry& s : symmetries) names.push_back(s.name);
  return names;
}

double failure(const System& system, const Eigen::Matrix4d& map, double sign, std::mt19937& generator) {
  const std::vector<double> state = random_state(system, generator);
  const Eigen::Vector4d z = Eigen::Map<const Eigen::Vector4d>(state.data());
  const Eigen::Vector4d image = map * z;
  Eigen::Vector4d f;
  Eigen::Vector4d g;
  system.field(1, z.data(), f.data());
  system.field(1, image.data(), g.data());
  return (g - sign * (map * f)).norm();
}

// identities_test holds every declared symmetry against the field, but draws no equal bodies; and here none is missed:
// of the sixteen changes of sign, those declared are all that hold.
TEST(Pcr3bp, SymmetriesAreThoseOfTheMasses) {
  std::mt19937 generator(13);
  using Names = std::vector<std::string>;
  for (const double mu : {0.5, std::nextafter(0.5, 0.0), 0.499, 0.3, earth_moon, 1e-9}) {
    SCOPED_TRACE(mu);
    const auto system = make_system("pcr3bp", {{"mu", mu}});
    const Structure& structure = system->structure();
    const bool equal = mu > 0.49999;  // to rounding
    EXPECT_EQ(names_of(structure.equivariances), equal ? Names{"S"} : Names{});
    EXPECT_EQ(names_of(structure.reversors), (equal ? Names{"R", "RS"} : Names{"R"}));
    for (const Symmetry& s : structure.equivariances)
      EXPECT_LT(failure(*system, s.map.matrix, 1.0, generator), 1e-14) << s.name;
    for (const Symmetry& r : structure.reversors)
      EXPECT_LT(failure(*system, r.map.matrix, -1.0, generator), 1e-14) << r.name;
    if (mu != 0.5 && mu > 0.49999) continue;  // within rounding of equal bodies
    const auto signs = [](unsigned bits) {
      Eigen::Vector4d diagonal;
      for (Eigen::Index i = 0; i < 4; ++i) diagonal(i) = (bits >> i) % 2 == 0 ? 1.0 : -1.0;
      return Eigen::Matrix4d(diagonal.asDiagonal());
    };
    std::size_t equivariances = 0;
    std::size_t reversors = 0;
    for (unsigned bits = 1; bits < 16; ++bits) {
      equivariances += failure(*system, signs(bits), 1.0, generator) < 1e-12 ? 1 : 0;
      reversors += failure(*system, signs(bits), -1.0, generator) < 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(equivariances, structure.equivariances.size());
    EXPECT_EQ(reversors, structure.reversors.size());
  }
}

TEST(Pcr3bp, MassesOutOfRangeAreRefused) {
  for (const double mu : {0.0, -0.1, 0.5000001, 1.0})
    EXPECT_THROW(static_cast<void>(make_system("pcr3bp", {{"mu", mu}})), core::InputError) << mu;
}

}  // namespace
}  // namespace orbweaver::systems::pcr3bp_test
