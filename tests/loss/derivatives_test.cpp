// Taylor tests: the remainder after the gradient is of order 2, after the full Hessian of order 3, by halving the step.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "loss/cases.hpp"
#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::loss::derivatives_test {
namespace {

using test::Case;
using test::make_case;
using test::vector_of;
using test::view;
using Order = Linearization::Order;

constexpr int halvings = 4;

void expect_order(const std::function<double(double)>& remainder, double first_step, double order,
                  const std::string& what) {
  double last = remainder(first_step);
  ASSERT_GT(last, 0.0) << what << ": nothing remains to be measured";
  for (int n = 1; n <= halvings; ++n) {
    const double next = remainder(std::ldexp(first_step, -n));
    EXPECT_NEAR(std::log2(last / next), order, 0.1) << what << ", halving " << n << ": " << last << " -> " << next;
    last = next;
  }
}

class LossDerivatives : public ::testing::TestWithParam<std::string> {
 protected:
  const Case sample = make_case(GetParam());
  const Linearization here = test::linearize(sample, Order::second);
  const int size = sample.unknowns.size();

  [[nodiscard]] double loss_at(const Eigen::VectorXd& u) const {
    return test::linearize(sample, u, Order::residual).loss();
  }
  [[nodiscard]] Eigen::VectorXd residual_at(const Eigen::VectorXd& u) const {
    return vector_of(test::linearize(sample, u, Order::residual).residual());
  }
  [[nodiscard]] Eigen::VectorXd gradient() const { return vector_of(here.gradient(sample.unknowns)); }
  [[nodiscard]] Eigen::VectorXd hessian_times(const Eigen::VectorXd& v, Curvature curvature) const {
    return vector_of(here.apply_hessian(sample.unknowns, view(v), curvature));
  }
  // |loss(u + h v) - loss - h g.v - h^2/2 v.H v| as a function of h.
  [[nodiscard]] std::function<double(double)> remainder_after_hessian(std::uint64_t seed, Curvature curvature) const {
    const Eigen::VectorXd v = test::unit_direction(size, seed);
    const double slope = gradient().dot(v);
    const double bend = v.dot(hessian_times(v, curvature));
    return [this, v, slope, bend](double h) {
      return std::abs(loss_at(h * v) - here.loss() - h * slope - 0.5 * h * h * bend);
    };
  }
};

TEST_P(LossDerivatives, LoopIsFarFromAnOrbit) { EXPECT_GT(here.loss(), 0.1); }

TEST_P(LossDerivatives, GradientLeavesARemainderOfOrderTwo) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Eigen::VectorXd v = test::unit_direction(size, seed);
    const double slope = gradient().dot(v);
    ASSERT_GT(std::abs(slope), 1e-3);
    expect_order([&](double h) { return std::abs(loss_at(h * v) - here.loss() - h * slope); }, 1e-3, 2.0, "gradient");
  }
}

TEST_P(LossDerivatives, FullHessianLeavesARemainderOfOrderThree) {
  for (const std::uint64_t seed : {4u, 5u, 6u})
    expect_order(remainder_after_hessian(seed, Curvature::full), 4e-3, 3.0, "full Hessian");
}

// Away from an orbit the Gauss-Newton Hessian leaves out a term, so that the same test sees only order 2.
TEST_P(LossDerivatives, GaussNewtonHessianLeavesARemainderOfOrderTwo) {
  expect_order(remainder_after_hessian(5, Curvature::gauss_newton), 2e-4, 2.0, "Gauss-Newton Hessian");
}

TEST_P(LossDerivatives, FullHessianIsTheDerivativeOfTheGradient) {
  const Eigen::VectorXd v = test::unit_direction(size, 7);
  const Eigen::VectorXd change = hessian_times(v, Curvature::full);
  const auto gradient_at = [&](double h) {
    return vector_of(test::linearize(sample, h * v, Order::jacobian).gradient(sample.unknowns));
  };
  expect_order([&](double h) { return (gradient_at(h) - gradient_at(0.0) - h * change).norm(); }, 1e-3, 2.0, "H v");
}

TEST_P(LossDerivatives, JacobianIsTheDerivativeOfTheResidual) {
  const Eigen::VectorXd v = test::unit_direction(size, 8);
  const Eigen::VectorXd change = vector_of(here.apply_jacobian(sample.unknowns, view(v)));
  constexpr double h = 1e-5;
  const Eigen::VectorXd difference = (residual_at(h * v) - residual_at(-h * v)) / (2.0 * h);
  EXPECT_LT((difference - change).norm(), 1e-8 * change.norm());
  // Where the residual is of first degree in the unknowns nothing remains but rounding.
  if (sample.system->info().name == "harmonic_oscillator" || sample.system->info().name == "double_pendulum")
    expect_order([&](double step) { return (residual_at(step * v) - residual_at(0.0 * v) - step * change).norm(); },
                 1e-3, 2.0, "J v");
}

TEST_P(LossDerivatives, GradientIsTwiceTheTransposedJacobianTimesTheResidual) {
  const std::vector<double> residual = here.residual();
  const Eigen::VectorXd product = vector_of(here.apply_jacobian_transposed(sample.unknowns, residual));
  EXPECT_EQ(gradient(), 2.0 * product);
  EXPECT_NEAR(vector_of(residual).squaredNorm(), here.loss(), 1e-14 * here.loss());
}

TEST_P(LossDerivatives, TransposeIsTheTranspose) {
  const Eigen::VectorXd v = test::unit_direction(size, 9);
  const Eigen::VectorXd y = test::unit_direction(here.rows(), 10);
  const Eigen::VectorXd jv = vector_of(here.apply_jacobian(sample.unknowns, view(v)));
  const Eigen::VectorXd jty = vector_of(here.apply_jacobian_transposed(sample.unknowns, view(y)));
  EXPECT_NEAR(y.dot(jv), v.dot(jty), 1e-14 * (jv.norm() + jty.norm()));
}

TEST_P(LossDerivatives, HessiansAreSymmetric) {
  for (const Curvature curvature : {Curvature::gauss_newton, Curvature::full}) {
    const Eigen::VectorXd v = test::unit_direction(size, 11);
    const Eigen::VectorXd w = test::unit_direction(size, 12);
    const Eigen::VectorXd hv = hessian_times(v, curvature);
    const Eigen::VectorXd hw = hessian_times(w, curvature);
    EXPECT_NEAR(w.dot(hv), v.dot(hw), 1e-14 * (hv.norm() + hw.norm()));
  }
}

TEST_P(LossDerivatives, DoNotDependOnTheOrderOfTheLinearization) {
  const Linearization less = test::linearize(sample, Order::jacobian);
  const Eigen::VectorXd v = test::unit_direction(size, 13);
  EXPECT_EQ(less.loss(), here.loss());
  EXPECT_EQ(less.gradient(sample.unknowns), here.gradient(sample.unknowns));
  EXPECT_EQ(less.apply_hessian(sample.unknowns, view(v), Curvature::gauss_newton),
            here.apply_hessian(sample.unknowns, view(v), Curvature::gauss_newton));
  EXPECT_NEAR(test::linearize(sample, Order::residual).loss(), here.loss(), 1e-14 * here.loss());
}

INSTANTIATE_TEST_SUITE_P(Cases, LossDerivatives, ::testing::ValuesIn(test::case_names()),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace orbweaver::loss::derivatives_test
