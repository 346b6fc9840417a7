// A family of another kind than conservative: the limit cycle of van der Pol's oscillator, T and mu both solved for
// under a phase condition and a pin. The equations only count: no unfolding, since nothing is conserved.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/equations/orbit_solver.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "support/van_der_pol.hpp"

namespace orbweaver::corrector::limit_cycle_test {
namespace {

using loss::Scalar;

constexpr double period_at_one = 6.663286859323130;  // T(mu = 1), known to 15 digits
constexpr double accuracy = 1e-11;
constexpr int cutoff = 67;

/// T and mu are scalars 0 and 1.
enum Pinned { period = 0, mu = 1 };

loss::Unknowns unknowns() {
  return {loop::Subspace::unrestricted(2, cutoff), {Scalar::period(), Scalar::of_parameter("mu")}};
}

/// One scalar held, and the phase.
loss::Slice slice_at(const loss::Unknowns& unknowns, const loop::Loop& guess, Pinned pinned) {
  Eigen::MatrixXd conditions(unknowns.size(), 2);
  conditions.col(0) = Eigen::VectorXd::Unit(unknowns.size(), unknowns.subspace.size() + pinned);
  const std::vector<double> shift = unknowns.time_shift_direction(guess);
  conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size()).normalized();
  return {unknowns.size(), conditions};
}

Result solve(const loop::Loop& guess, double mu_of_guess, Pinned pinned, Method method = Method::newton_krylov) {
  const loss::Unknowns all = unknowns();
  Options options;
  options.method = method;
  return correct(test::VanDerPol(mu_of_guess), guess, all, slice_at(all, guess, pinned), options);
}

/// The cycle at mu = 0.9, from the circle of mu -> 0 by way of values in between.
const loop::Loop& nearby() {
  static const loop::Loop orbit = [] {
    loop::Loop guess = loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, cutoff);
    guess.cosine(1, 0) = 2.0;
    guess.sine(1, 1) = -2.0;
    for (const double value : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Result result = solve(guess, value, mu);
      EXPECT_TRUE(result.converged()) << value << ": " << result.detail;
      EXPECT_EQ(result.parameters, std::vector<double>{value});
      guess = result.loop;
    }
    return guess;
  }();
  return orbit;
}

loop::Loop with_period(loop::Loop loop, double period) {
  loop.period = period;
  return loop;
}

class LimitCycle : public testing::TestWithParam<Method> {};

TEST_P(LimitCycle, HasItsPeriodWhereMuIsPinned) {
  const Result result = solve(nearby(), 1.0, mu, GetParam());
  ASSERT_TRUE(result.converged()) << result.detail;
  EXPECT_EQ(result.parameters, std::vector<double>{1.0});
  EXPECT_NEAR(result.loop.period, period_at_one, accuracy);
}

TEST_P(LimitCycle, HasItsParameterWhereThePeriodIsPinned) {
  const Result result = solve(with_period(nearby(), period_at_one), 0.9, period, GetParam());
  ASSERT_TRUE(result.converged()) << result.detail;
  EXPECT_NEAR(result.loop.period, period_at_one, 1e-14);
  ASSERT_EQ(result.parameters.size(), 1U);
  EXPECT_NEAR(result.parameters[0], 1.0, accuracy);
}

INSTANTIATE_TEST_SUITE_P(Methods, LimitCycle, testing::Values(Method::newton_krylov, Method::nls, Method::automatic),
                         [](const auto& tested) {
                           return tested.param == Method::newton_krylov ? "NewtonKrylov"
                                  : tested.param == Method::nls         ? "Nls"
                                                                        : "Automatic";
                         });

struct Collocated {
  double period;
  double mu;
};

Collocated by_collocation(double period_from, double mu_from, Pinned pinned) {
  const test::VanDerPol system(mu_from);
  equations::Collocation equations(system, loop::fundamental_domain(system.structure(), {}), {0.0, 0.0}, {0.0, 0.0},
                                   160, {}, {Scalar::period(), Scalar::of_parameter("mu")});
  EXPECT_EQ(equations.borders(), 2);
  const auto size = static_cast<std::size_t>(equations.size());
  const int stride = equations.grid().stride();
  std::vector<double> u(size, 0.0);
  equations.from_loop(with_period(nearby(), period_from), u.data());
  EXPECT_EQ(u.back(), mu_from);
  std::vector<double> weights(2 * size, 0.0);
  weights[static_cast<std::size_t>(equations.period_at() + pinned)] = 1.0;
  std::vector<double> z(size);
  std::vector<double> slope(size);
  equations.grid().at_nodes(u.data(), z.data(), slope.data());
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < equations.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      weights[size + n] = equations.node_weights()[static_cast<std::size_t>(j)] * slope[n];
    }
  equations.set_conditions(weights, u);
  equations::OrbitSolver solver;
  const auto result = solver.solve(equations, u, false, {});
  EXPECT_TRUE(result.converged) << result.iterations << " " << result.last_change;
  return {u[size - 2], u[size - 1]};
}

TEST(CollocatedLimitCycle, HasItsPeriodWhereMuIsPinned) {
  const Collocated found = by_collocation(nearby().period, 1.0, mu);
  EXPECT_NEAR(found.mu, 1.0, 1e-14);
  EXPECT_NEAR(found.period, period_at_one, accuracy);
}

TEST(CollocatedLimitCycle, HasItsParameterWhereThePeriodIsPinned) {
  const Collocated found = by_collocation(period_at_one, 0.9, period);
  EXPECT_NEAR(found.period, period_at_one, 1e-14);
  EXPECT_NEAR(found.mu, 1.0, accuracy);
}

// As many conditions as scalars, unfoldings included: nothing else decides.
TEST(LimitCycleEquations, AreSquareByTheirCount) {
  const test::VanDerPol system(0.9);
  const loop::Subspace all = loop::Subspace::unrestricted(2, cutoff);
  const loss::Unknowns both = unknowns();
  const loss::Slice slice = slice_at(both, nearby(), mu);
  EXPECT_TRUE(equations::LoopEquations::are_square(system, both, all, slice));
  EXPECT_FALSE(equations::LoopEquations::are_square(system, both, all,
                                                    loss::Slice(both.size(), slice.conditions().leftCols(1))));
  const loss::Unknowns period_only{all, {Scalar::period()}};
  const Eigen::MatrixXd conditions = Eigen::MatrixXd::Identity(period_only.size(), 2);
  EXPECT_FALSE(
      equations::LoopEquations::are_square(system, period_only, all, loss::Slice(period_only.size(), conditions)))
      << "an unfolding of what is not conserved";
}

// The columns of T and mu, matrix-free and assembled, forwards and transposed, against differences.
TEST(LimitCycleEquations, HaveTheColumnsOfTheirScalars) {
  const loss::Unknowns both = unknowns();
  const test::VanDerPol system(0.8);
  const loss::Linearization at(system, nearby(), loss::Linearization::Order::jacobian, both.scalars);
  const auto residual = [&](double dt, double dmu) {
    return loss::Linearization(test::VanDerPol(0.8 + dmu), with_period(nearby(), nearby().period + dt),
                               loss::Linearization::Order::residual)
        .residual();
  };
  const double h = 1e-5;
  std::vector<double> y(static_cast<std::size_t>(at.rows()));
  for (std::size_t n = 0; n < y.size(); ++n) y[n] = std::sin(static_cast<double>(n));
  const std::vector<double> transposed = at.apply_jacobian_transposed(both, y);
  for (const int scalar : {0, 1}) {
    const std::vector<double> above = scalar == 0 ? residual(h, 0.0) : residual(0.0, h);
    const std::vector<double> below = scalar == 0 ? residual(-h, 0.0) : residual(0.0, -h);
    const auto place = static_cast<std::size_t>(both.subspace.size() + scalar);
    std::vector<double> unit(static_cast<std::size_t>(both.size()), 0.0);
    unit[place] = 1.0;
    const std::vector<double> column = at.apply_jacobian(both, unit);
    double along = 0.0;
    for (std::size_t n = 0; n < column.size(); ++n) {
      EXPECT_NEAR(column[n], (above[n] - below[n]) / (2.0 * h), 1e-9) << scalar << " " << n;
      along += column[n] * y[n];
    }
    EXPECT_NEAR(transposed[place], along, 1e-12);
  }
  EXPECT_THROW(static_cast<void>(loss::Linearization(system, nearby(), loss::Linearization::Order::jacobian)
                                     .apply_jacobian(both, std::vector<double>(static_cast<std::size_t>(both.size())))),
               core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::corrector::limit_cycle_test
