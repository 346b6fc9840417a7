// The chain of pendulums against the double pendulum, against its Lagrangian, and against the zeros of Laguerre's
// polynomials.
#include <cmath>
#include <complex>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::pendulum_chain_test {
namespace {

using Complex = std::complex<double>;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Parameters = std::map<std::string, double>;

Parameters parameters_of(int links, std::mt19937& generator) {
  Parameters parameters = random_parameters(model_info("pendulum_chain"), generator);
  parameters["links"] = links;
  return parameters;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, const char* what) {
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * (1.0 + largest(b))) << what << " " << i;
}

TEST(PendulumChain, WithTwoLinksIsTheDoublePendulum) {
  constexpr std::size_t nodes = 7;  // no multiple of the lanes
  std::mt19937 generator{5};
  for (int sample = 0; sample < 10; ++sample) {
    const Parameters p = parameters_of(2, generator);
    const auto chain = make_system("pendulum_chain", p);
    const auto pendulum =
        make_system("double_pendulum",
                    {{"m1", p.at("m")}, {"m2", p.at("m")}, {"l1", p.at("l")}, {"l2", p.at("l")}, {"g", p.at("g")}});
    const auto z = random_numbers(4 * nodes, generator);
    const auto weights = random_numbers(4 * nodes, generator);
    const auto results = [&](const System& system) {
      std::map<std::string, std::vector<double>> all{
          {"f", std::vector<double>(4 * nodes)},         {"f with Jacobian", std::vector<double>(4 * nodes)},
          {"Jacobian", std::vector<double>(16 * nodes)}, {"second derivatives", std::vector<double>(16 * nodes)},
          {"df/dg", std::vector<double>(4 * nodes)},     {"grad E", std::vector<double>(4 * nodes)}};
      system.field(nodes, z.data(), all["f"].data());
      system.field_jacobian(nodes, z.data(), all["f with Jacobian"].data(), all["Jacobian"].data());
      system.second_derivatives(nodes, z.data(), weights.data(), all["second derivatives"].data());
      system.parameter_derivatives("g", nodes, z.data(), all["df/dg"].data());
      system.conserved_gradients(0, nodes, z.data(), all["grad E"].data());
      all["E and action"] = {system.conserved(0, {z.data(), 4}), system.action_density({z.data(), 4})};
      return all;
    };
    const auto expected = results(*pendulum);
    for (const auto& [what, values] : results(*chain)) expect_near(values, expected.at(what), what.c_str());
  }
}

/// The kinetic energy less the potential one, told by the places of the bobs.
Complex lagrangian(const Parameters& p, const Eigen::VectorXcd& angles, const Eigen::VectorXcd& rates) {
  Complex vx = 0.0;
  Complex vy = 0.0;
  Complex y = 0.0;
  Complex sum = 0.0;
  for (Eigen::Index k = 0; k < angles.size(); ++k) {
    vx += p.at("l") * std::cos(angles(k)) * rates(k);
    vy += p.at("l") * std::sin(angles(k)) * rates(k);
    y -= p.at("l") * std::cos(angles(k));
    sum += p.at("m") * ((vx * vx + vy * vy) / 2.0 - p.at("g") * y);
  }
  return sum;
}

TEST(PendulumChain, SolvesTheEquationsOfItsLagrangian) {
  // L is a polynomial of degree two in the rates, so differences in them are exact; in time and in angles a complex
  // step is.
  constexpr double h = 1e-100;
  const Complex step(0.0, h);
  std::mt19937 generator{6};
  for (const int links : {1, 2, 3, 7, 20})
    for (int sample = 0; sample < 5; ++sample) {
      const Parameters p = parameters_of(links, generator);
      const auto system = make_system("pendulum_chain", p);
      const auto z = random_numbers(static_cast<std::size_t>(2 * links), generator);
      std::vector<double> f(z.size());
      system->field(1, z.data(), f.data());
      const Eigen::VectorXd state = Eigen::Map<const Eigen::VectorXd>(z.data(), 2 * links);
      const Eigen::VectorXd slope = Eigen::Map<const Eigen::VectorXd>(f.data(), 2 * links);
      EXPECT_EQ(slope.head(links), state.tail(links));
      const Eigen::VectorXcd angles = state.head(links).cast<Complex>();
      const Eigen::VectorXcd rates = state.tail(links).cast<Complex>();
      const Eigen::VectorXcd later = angles + step * slope.head(links).cast<Complex>();
      const Eigen::VectorXcd faster = rates + step * slope.tail(links).cast<Complex>();
      double size = 0.0;
      double error = 0.0;
      for (int j = 0; j < links; ++j) {
        const Eigen::VectorXcd unit = Eigen::VectorXcd::Unit(links, j);
        const Complex momentum = (lagrangian(p, later, faster + unit) - lagrangian(p, later, faster - unit)) / 2.0;
        const double force = lagrangian(p, angles + step * unit, rates).imag() / h;
        size = std::max(size, std::abs(force));
        error = std::max(error, std::abs(momentum.imag() / h - force));
      }
      EXPECT_LT(error, 1e-12 * links * (1.0 + size)) << links << " links";

      const double energy = (lagrangian(p, angles, rates) - 2.0 * lagrangian(p, angles, 0.0 * rates)).real();
      EXPECT_NEAR(system->conserved(0, z), energy, 1e-13 * links * (1.0 + std::abs(energy)));
      const double twice = 2.0 * (lagrangian(p, angles, rates) - lagrangian(p, angles, 0.0 * rates)).real();
      EXPECT_NEAR(system->action_density(z), twice, 1e-13 * links * (1.0 + twice));
    }
}

/// Squares of the angular frequencies of small oscillations around the hanging chain, ascending.
Eigen::VectorXd squares_of_frequencies(const System& system) {
  const Eigen::Index d = system.dimension();
  const std::vector<double> rest(static_cast<std::size_t>(d), 0.0);
  std::vector<double> f(rest.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(d, d);
  system.field_jacobian(1, rest.data(), f.data(), jacobian.data());
  const Eigen::MatrixXd stiffness = -jacobian.bottomLeftCorner(d / 2, d / 2);
  EXPECT_EQ(jacobian.bottomRightCorner(d / 2, d / 2).norm(), 0.0);
  Eigen::VectorXd squares = stiffness.eigenvalues().real();
  EXPECT_LT(stiffness.eigenvalues().imag().norm(), 1e-10);
  std::sort(squares.begin(), squares.end());
  return squares;
}

TEST(PendulumChain, SwingsAsItsMassAndStiffnessMatricesSay) {
  std::mt19937 generator{7};
  for (const int links : {1, 2, 4, 10, 25}) {
    const Parameters p = parameters_of(links, generator);
    Eigen::MatrixXd mass(links, links);
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(links, links);
    for (int j = 0; j < links; ++j) {
      stiffness(j, j) = p.at("m") * p.at("g") * p.at("l") * (links - j);
      for (int k = 0; k < links; ++k) mass(j, k) = p.at("m") * p.at("l") * p.at("l") * (links - std::max(j, k));
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(stiffness, mass);
    const Eigen::VectorXd squares = squares_of_frequencies(*make_system("pendulum_chain", p));
    EXPECT_LT((squares - solved.eigenvalues()).norm(), 1e-11 * squares.norm()) << links << " links";
  }
}

// At rest the rod above bob i (counted from the free end, from 0) carries m g (i + 1). With a displacement x_i sideways
//   (i + 1) x_(i+1) = (2 i + 1 - w^2 l/g) x_i - i x_(i-1),
// the recurrence of Laguerre's polynomials in w^2 l/g; the pivot stands where x_n = 0.
TEST(PendulumChain, SwingsWithTheZerosOfLaguerresPolynomials) {
  std::mt19937 generator{8};
  for (const int links : {1, 2, 4, 10, 15}) {
    const Parameters p = parameters_of(links, generator);
    const auto n = static_cast<unsigned>(links);
    const Eigen::VectorXd squares = squares_of_frequencies(*make_system("pendulum_chain", p)) * (p.at("l") / p.at("g"));
    for (Eigen::Index k = 0; k < squares.size(); ++k) {
      const double x = squares(k);
      EXPECT_GT(x, k > 0 ? squares(k - 1) * (1.0 + 1e-3) : 0.0);
      const double slope = n * (std::laguerre(n, x) - std::laguerre(n - 1, x)) / x;
      EXPECT_LT(std::abs(std::laguerre(n, x) / slope), 1e-11 * squares(links - 1)) << links << " links, mode " << k;
    }
  }
}

TEST(PendulumChain, NamesItsLinks) {
  const auto system = make_system("pendulum_chain", {{"links", 12}});
  EXPECT_EQ(system->dimension(), 24);
  EXPECT_EQ(system->info().state_names[11], "th12");
  EXPECT_EQ(system->info().state_names[12], "w1");
  EXPECT_EQ(system->winding_names().size(), 12U);
  EXPECT_EQ(system->winding_names().back(), "n12");
  EXPECT_EQ(system->structure().pairs(), 11);
}

TEST(PendulumChain, RefusesNumbersOfLinksThatAreNone) {
  const auto with = [](double links) { return [links] { (void)make_system("pendulum_chain", {{"links", links}}); }; };
  EXPECT_THAT(with(2.5), ThrowsMessage<core::InputError>(AllOf(HasSubstr("whole number"), HasSubstr("2.5 came"))));
  for (const double links : {0.0, -1.0, 101.0, std::nan("")})
    EXPECT_THAT(with(links), ThrowsMessage<core::InputError>(HasSubstr("1 <= links <= 100")));
  EXPECT_THAT(([] { (void)make_system("pendulum_chain", {}, {}, {.free = {"links"}}); }),
              ThrowsMessage<core::InputError>(HasSubstr("nothing can be continued in it")));
  const auto system = make_system("pendulum_chain", {{"links", 4}});
  const std::vector<double> z(8);
  std::vector<double> derivatives(8);
  EXPECT_THROW(system->parameter_derivatives("links", 1, z.data(), derivatives.data()), core::MisuseError);
  EXPECT_THROW((void)system->with_parameters({{"links", 5.0}}), core::MisuseError);
  EXPECT_EQ(system->with_parameters({{"links", 4.0}, {"g", 2.0}})->dimension(), 8);
}

}  // namespace
}  // namespace orbweaver::systems::pendulum_chain_test
