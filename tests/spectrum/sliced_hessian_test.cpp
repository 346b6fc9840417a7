#include "orbweaver/spectrum/sliced_hessian.hpp"

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/matrices.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::spectrum::sliced_hessian_test {
namespace {

std::span<const double> view(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// The in-phase loops of one cutoff, and the direction in which the amplitude grows.
struct InPhase {
  explicit InPhase(double amplitude, int cutoff = 22)
      : guess(test::linear_loop(test::in_phase(), amplitude, cutoff)),
        unknowns{loop::Subspace(4, cutoff, test::pendulum_isotropy(*system)), {loss::Scalar::period()}},
        normal(direction_of_growth()),
        slice(unknowns.size(), normal) {}

  [[nodiscard]] Eigen::VectorXd direction_of_growth() const {
    const loop::Loop base = loop::constant_loop(std::vector<double>(4, 0.0), guess.period, guess.cutoff);
    const std::vector<double> u = unknowns.difference(base, guess);
    return Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size()));
  }
  [[nodiscard]] loss::Linearization linearize(const loop::Loop& loop) const {
    return {*system, loop, loss::Linearization::Order::jacobian};
  }
  /// Newton's method by hand on dense least squares: nothing of the class under test.
  [[nodiscard]] Eigen::VectorXd least_squares_step(const loop::Loop& loop) const {
    const loss::Linearization linearization = linearize(loop);
    const Eigen::MatrixXd j = test::to_dense(slice.reduce_columns(loss::assemble_jacobian(linearization, unknowns)));
    const std::vector<double> r = linearization.residual();
    const Eigen::VectorXd x = j.colPivHouseholderQr().solve(
        -Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size())));
    return slice.expand(x);
  }
  [[nodiscard]] loop::Loop orbit() const {
    loop::Loop loop = guess;
    for (int n = 0; n < 8; ++n) loop = unknowns.moved(loop, view(least_squares_step(loop)));
    return loop;
  }

  std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  loop::Loop guess;
  loss::Unknowns unknowns;
  Eigen::VectorXd normal;
  loss::Slice slice;
};

// Normal equations square the condition number of J on the slice (about 1e3 here): 1e6 eps.
TEST(SlicedHessian, NewtonStepIsThatOfDenseLeastSquares) {
  const InPhase problem(0.3);
  const loss::Linearization linearization = problem.linearize(problem.guess);
  const SlicedHessian hessian(linearization, problem.unknowns, problem.slice);
  const Eigen::VectorXd step = hessian.newton_step();
  const Eigen::VectorXd expected = problem.least_squares_step(problem.guess);
  EXPECT_GT(expected.norm(), 1e-3) << "the guess is already an orbit";
  EXPECT_LT((step - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LT(std::abs(step.dot(problem.normal)), 1e-14 * step.norm() * problem.normal.norm());
  EXPECT_EQ(hessian.shift(), 0.0);
}

TEST(SlicedHessian, NewtonStepVanishesAtAnOrbit) {
  const InPhase problem(0.3);
  const loop::Loop orbit = problem.orbit();
  const loss::Linearization linearization = problem.linearize(orbit);
  ASSERT_LT(std::sqrt(linearization.loss()), 1e-13);
  EXPECT_LT(SlicedHessian(linearization, problem.unknowns, problem.slice).newton_step().norm(), 1e-12);
}

class FlatDirection : public testing::TestWithParam<double> {};

TEST_P(FlatDirection, IsTheZeroEigenvectorAtAnOrbit) {
  const InPhase problem(GetParam());
  const loss::Linearization linearization = problem.linearize(problem.orbit());
  const auto whole = loss::assemble_hessian(linearization, problem.unknowns, loss::Curvature::gauss_newton);
  const Eigenpairs pairs = smallest_eigenpairs(whole, {.count = 2});
  const double norm = test::to_dense(whole).norm();
  ASSERT_LT(std::abs(pairs.values[0]), 1e-14 * norm);
  ASSERT_GT(pairs.values[1], 1e-8 * norm) << "no gap above the zero eigenvalue";

  const SlicedHessian hessian(linearization, problem.unknowns, problem.slice);
  const Eigen::VectorXd flat = hessian.flat_direction(problem.normal);
  EXPECT_NEAR(flat.norm(), 1.0, 1e-14);
  EXPECT_GT(flat.dot(problem.normal), 0.0) << "the flat direction lies on the normal's side";
  // An eigenvector is known to eps |H| / gap.
  const Eigen::VectorXd eigenvector = pairs.vectors.col(0);
  const double sign = flat.dot(eigenvector) < 0.0 ? -1.0 : 1.0;
  EXPECT_LT((flat - sign * eigenvector).norm(), 1e-15 * norm / pairs.values[1] + 1e-12);
}

// The direction does not depend on the slice it is computed through.
TEST_P(FlatDirection, IsTheSameThroughATiltedSlice) {
  const InPhase problem(GetParam());
  const loss::Linearization linearization = problem.linearize(problem.orbit());
  const Eigen::VectorXd straight =
      SlicedHessian(linearization, problem.unknowns, problem.slice).flat_direction(problem.normal);
  Eigen::VectorXd tilted = problem.normal.normalized();
  tilted(problem.unknowns.size() - 1) += 0.5;
  tilted(0) += 0.3;
  const loss::Slice slice(problem.unknowns.size(), tilted);
  const Eigen::VectorXd through_tilted = SlicedHessian(linearization, problem.unknowns, slice).flat_direction(tilted);
  EXPECT_LT((straight - through_tilted).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Amplitudes, FlatDirection, testing::Values(0.05, 0.2, 0.4));

// At an orbit H has a zero eigenvalue along the family: without a condition it factors only with something added.
TEST(SlicedHessian, FactorsASingularHessianWithAShiftThatItReports) {
  const InPhase problem(0.3);
  const loss::Linearization linearization = problem.linearize(problem.orbit());
  const auto whole = loss::assemble_hessian(linearization, problem.unknowns, loss::Curvature::gauss_newton);
  const double norm = test::to_dense(whole).cwiseAbs().rowwise().sum().maxCoeff();
  const SlicedHessian hessian(linearization, problem.unknowns,
                              loss::Slice(problem.unknowns.size(), Eigen::MatrixXd(problem.unknowns.size(), 0)));
  EXPECT_GE(hessian.shift(), 0.0);
  EXPECT_LE(hessian.shift(), 1e-12 * norm);
  EXPECT_TRUE(hessian.newton_step().allFinite());
}

}  // namespace
}  // namespace orbweaver::spectrum::sliced_hessian_test
