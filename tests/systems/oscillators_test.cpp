// Duffing's and van der Pol's oscillators and Lorenz's system against equations written in another way, and against
// what is known of their orbits.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/taylor/flow.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::oscillators_test {
namespace {

using Parameters = std::map<std::string, double>;

/// The state after `time`, by Taylor series.
std::vector<double> after(const System& system, std::vector<double> state, double time) {
  const Formulas formulas = dynamic_cast<const FormulaSystem&>(system).formulas();
  taylor::Flow<double> flow(formulas, formulas.values, {});
  flow.advance(state, time);
  return state;
}

// Energy conservation gives x' as a function of x, and the period of amplitude a as a complete elliptic integral:
// T = 4 K(k)/sqrt(alpha + beta a^2), k^2 = beta a^2/(2 (alpha + beta a^2)).
TEST(Duffing, HasThePeriodOfTheEllipticIntegral) {
  for (const auto& [alpha, beta, a] :
       {std::array{1.0, 1.0, 2.0}, std::array{0.5, 3.0, 0.7}, std::array{2.0, 0.0, 1.0}}) {
    const auto system = make_system("duffing", {{"alpha", alpha}, {"beta", beta}});
    const double stiff = alpha + beta * a * a;
    const double period = 4.0 * std::comp_ellint_1(std::sqrt(0.5 * beta * a * a / stiff)) / std::sqrt(stiff);
    const std::vector<double> end = after(*system, {a, 0.0}, period);
    EXPECT_NEAR(end[0], a, 1e-12);
    EXPECT_NEAR(end[1], 0.0, 1e-12);
    const double quarter = after(*system, {a, 0.0}, 0.25 * period)[0];
    EXPECT_NEAR(quarter, 0.0, 1e-12);
  }
}

// Without the cubic term the driven, damped oscillation is known: x = Re(F e^(i phase)/(alpha - w^2 + i damping w)).
TEST(Duffing, AnswersADriveAsALinearOscillatorWithoutItsCubicTerm) {
  const double alpha = 2.0, damping = 0.3, force = 0.7, w = 1.3;
  const auto system = make_system(
      "duffing",
      {{"alpha", alpha}, {"beta", 0.0}, {"damping", damping}, {"drive_amplitude", force}, {"drive_frequency", w}},
      {"damping", "drive"});
  const std::complex<double> x = force / std::complex<double>(alpha - w * w, damping * w);
  const double phase = 0.4;
  const auto state_at = [&](double at) {
    const std::complex<double> now = x * std::polar(1.0, at);
    return std::vector<double>{now.real(), -w * now.imag(), at};
  };
  const std::vector<double> end = after(*system, state_at(phase), 5.0);
  const std::vector<double> expected = state_at(phase + 5.0 * w);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end[i], expected[i], 1e-13 * 10.0) << i;
}

// Lienard's plane: with w = v + mu (x^3/3 - x) the equations are x' = w - mu (x^3/3 - x), w' = -x.
TEST(VanDerPol, FollowsFromLienardsEquations) {
  std::mt19937 generator(5);
  for (int sample = 0; sample < 50; ++sample) {
    const Parameters parameters = random_parameters(model_info("van_der_pol"), generator);
    const double mu = parameters.at("mu");
    const auto z = random_numbers(2, generator);
    std::vector<double> f(2);
    make_system("van_der_pol", parameters)->field(1, z.data(), f.data());
    EXPECT_EQ(f[0], z[1]);
    const double w_dot = f[1] + mu * (z[0] * z[0] - 1.0) * f[0];
    EXPECT_NEAR(w_dot, -z[0], 1e-13 * (1.0 + mu * z[0] * z[0] * std::abs(z[1])));
  }
}

// T(1) = 6.663286859323130, T(10) = 19.07836956694.
TEST(VanDerPol, HasItsKnownPeriods) {
  for (const auto& [mu, period] : {std::array{1.0, 6.663286859323130}, std::array{10.0, 19.07836956694}}) {
    const auto system = make_system("van_der_pol", {{"mu", mu}});
    const std::vector<double> on_cycle = after(*system, {2.0, 0.0}, 10.0 * period);
    const std::vector<double> once = after(*system, on_cycle, period);
    const double speed = std::hypot(on_cycle[1], 1.0) * mu;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(once[i], on_cycle[i], 1e-11 * speed) << mu;
  }
}

// Equilibria at +-sqrt(beta (rho - 1)); their eigenvalues solve l^3 + (sigma + beta + 1) l^2 + beta (sigma + rho) l +
// 2 sigma beta (rho - 1) = 0, which at rho = 470/19 has a pair on the imaginary axis (Lorenz 1963).
TEST(Lorenz, HasItsKnownHopfPoint) {
  const double sigma = 10.0, beta = 8.0 / 3.0, rho = 470.0 / 19.0;
  const auto system = make_system("lorenz", {{"rho", rho}});
  const double x = std::sqrt(beta * (rho - 1.0));
  for (const double side : {1.0, -1.0}) {
    const std::vector<double> z{side * x, side * x, rho - 1.0};
    std::vector<double> f(3);
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> jacobian;
    system->field_jacobian(1, z.data(), f.data(), jacobian.data());
    for (const double component : f) EXPECT_NEAR(component, 0.0, 1e-13);
    EXPECT_NEAR(jacobian.trace(), -(sigma + 1.0 + beta), 1e-14);
    const Eigen::Matrix3d square = jacobian * jacobian;
    EXPECT_NEAR(0.5 * (std::pow(jacobian.trace(), 2) - square.trace()), beta * (sigma + rho), 1e-11);
    EXPECT_NEAR(jacobian.determinant(), -2.0 * sigma * beta * (rho - 1.0), 1e-10);
    const Eigen::VectorXcd values = Eigen::MatrixXd(jacobian).eigenvalues();
    double nearest = 1.0;
    for (const std::complex<double>& value : values)
      if (std::abs(value.imag()) > 1.0) nearest = std::min(nearest, std::abs(value.real()));
    EXPECT_LT(nearest, 1e-13);
  }
}

// The orbit around both lobes once at rho = 28 (D. Viswanath 2003, doi:10.1088/0951-7715/16/3/314): T = 1.558652210716.
TEST(Lorenz, HasItsKnownOrbit) {
  const std::vector<double> start{-13.763610682134, -19.578751942452, 27.0};
  const auto system = make_system("lorenz");
  const std::vector<double> end = after(*system, start, 1.558652210716);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end[i], start[i], 1e-9) << i;
  const std::vector<double> half = after(*system, start, 0.5 * 1.558652210716);  // S of the start
  EXPECT_NEAR(half[0], -start[0], 1e-9);
  EXPECT_NEAR(half[1], -start[1], 1e-9);
}

}  // namespace
}  // namespace orbweaver::systems::oscillators_test
