#include "orbweaver/loss/assembled.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "loss/cases.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss::matrices_test {
namespace {

using test::Case;
using test::make_case;
using Order = Linearization::Order;

Eigen::MatrixXd dense(const core::Handle<Mat>& matrix) {
  Eigen::MatrixXd copy;
  with_dense_array(matrix, [&](DenseMap map) { copy = map; });
  return copy;
}

/// The matrix of a linear function of `size` numbers.
Eigen::MatrixXd matrix_of(int size, const std::function<std::vector<double>(std::span<const double>)>& function) {
  Eigen::MatrixXd out;
  for (int n = 0; n < size; ++n) {
    const Eigen::VectorXd column = test::vector_of(function(test::view(Eigen::VectorXd::Unit(size, n))));
    out.conservativeResize(column.size(), size);
    out.col(n) = column;
  }
  return out;
}

class LossMatrices : public ::testing::TestWithParam<std::string> {
 protected:
  const Case sample = make_case(GetParam());
  const std::shared_ptr<const Linearization> here =
      std::make_shared<Linearization>(test::linearize(sample, Order::second));
  const std::shared_ptr<const Unknowns> unknowns = std::make_shared<Unknowns>(sample.unknowns);
};

TEST_P(LossMatrices, JacobianIsTheSameAssembledAndMatrixFree) {
  const Eigen::MatrixXd assembled = dense(assemble_jacobian(*here, *unknowns));
  EXPECT_EQ(assembled.rows(), here->rows());
  EXPECT_EQ(assembled.cols(), unknowns->size());
  const Eigen::MatrixXd products =
      matrix_of(unknowns->size(), [&](auto v) { return here->apply_jacobian(*unknowns, v); });
  EXPECT_LT((products - assembled).norm(), 1e-12 * assembled.norm());
  const Eigen::VectorXd y = test::unit_direction(here->rows(), 21);
  EXPECT_LT(
      (test::vector_of(here->apply_jacobian_transposed(*unknowns, test::view(y))) - assembled.transpose() * y).norm(),
      1e-12 * assembled.norm());
}

TEST_P(LossMatrices, HessianIsTheSameAssembledAndMatrixFree) {
  for (const Curvature curvature : {Curvature::gauss_newton, Curvature::full}) {
    const Eigen::MatrixXd assembled = dense(assemble_hessian(*here, *unknowns, curvature));
    EXPECT_EQ(assembled.rows(), unknowns->size());
    EXPECT_EQ(assembled, assembled.transpose());
    const Eigen::MatrixXd products =
        matrix_of(unknowns->size(), [&](auto v) { return here->apply_hessian(*unknowns, v, curvature); });
    EXPECT_LT((products - assembled).norm(), 1e-12 * assembled.norm());
  }
}

// The assembly from Fourier sums against the product of the assembled Jacobian, which knows nothing of them.
TEST_P(LossMatrices, GaussNewtonHessianIsTwiceTheJacobianSquared) {
  const Eigen::MatrixXd j = dense(assemble_jacobian(*here, *unknowns));
  const Eigen::MatrixXd h = dense(assemble_hessian(*here, *unknowns, Curvature::gauss_newton));
  EXPECT_LT((2.0 * j.transpose() * j - h).norm(), 1e-13 * h.norm());
}

TEST_P(LossMatrices, FullHessianDiffersAwayFromAnOrbit) {
  const Eigen::MatrixXd gauss_newton = dense(assemble_hessian(*here, *unknowns, Curvature::gauss_newton));
  const Eigen::MatrixXd full = dense(assemble_hessian(*here, *unknowns, Curvature::full));
  EXPECT_GT((full - gauss_newton).norm(), 1e-4 * full.norm());
}

INSTANTIATE_TEST_SUITE_P(Cases, LossMatrices, ::testing::ValuesIn(test::all_case_names()),
                         [](const auto& param) { return param.param; });

TEST(MatricesMisuse, IsRefused) {
  const Case sample = make_case("pendulum_symmetric_period");
  const Linearization residual = test::linearize(sample, Order::residual);
  const Linearization jacobian = test::linearize(sample, Order::jacobian);
  EXPECT_THROW(static_cast<void>(assemble_jacobian(residual, sample.unknowns)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(assemble_hessian(residual, sample.unknowns, Curvature::gauss_newton)),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(assemble_hessian(jacobian, sample.unknowns, Curvature::full)), core::MisuseError);
  const Unknowns larger{loop::Subspace::unrestricted(4, 20), {}};
  const Unknowns flatter{loop::Subspace::unrestricted(2, 9), {}};
  for (const Unknowns& other : {larger, flatter}) {
    EXPECT_THROW(static_cast<void>(assemble_jacobian(jacobian, other)), core::MisuseError);
    EXPECT_THROW(static_cast<void>(assemble_hessian(jacobian, other, Curvature::gauss_newton)), core::MisuseError);
  }
}

TEST(DenseMatrices, AreGivenBackWhenTheBodyThrows) {
  const core::Handle<Mat> matrix = create_dense(3, 2);
  EXPECT_THROW(with_dense_array(matrix, [](DenseMap) { throw std::runtime_error("no"); }), std::runtime_error);
  with_dense_array(matrix, [](DenseMap map) { map(2, 1) = 5.0; });
  PetscScalar value = 0.0;
  const PetscInt row = 2;
  const PetscInt column = 1;
  core::check(MatGetValues(matrix.get(), 1, &row, 1, &column, &value), "MatGetValues");
  EXPECT_EQ(value, 5.0);
}

TEST(DenseVectors, AreCopiedBothWays) {
  const core::Handle<Vec> vector = create_vector(3);
  EXPECT_EQ(to_eigen(vector.get()), Eigen::VectorXd::Zero(3));
  const Eigen::Vector3d values(1.0, -2.0, 3.0);
  assign(vector.get(), values);
  EXPECT_EQ(to_eigen(vector.get()), values);
  EXPECT_THROW(assign(vector.get(), Eigen::VectorXd::Zero(4)), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loss::matrices_test
