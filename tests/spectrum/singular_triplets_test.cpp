#include "orbweaver/spectrum/singular_triplets.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "spectrum/matrices.hpp"

namespace orbweaver::spectrum::singular_triplets_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// |J| = 1e3, the smallest singular value 1e-9, the next 1, the others spread evenly in the logarithm from 1 to 1e3.
Eigen::VectorXd steep_values(int columns) {
  Eigen::VectorXd values(columns);
  values(0) = 1e-9;
  for (int n = 1; n < columns; ++n) values(n) = std::pow(1e3, (n - 1.0) / (columns - 2.0));
  return values;
}

/// A matrix with these singular values, formed in extended precision so that only its last rounding disturbs them.
Eigen::MatrixXd with_singular_values(const Eigen::VectorXd& values, int rows, unsigned seed) {
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const auto columns = static_cast<int>(values.size());
  const auto orthonormal = [](const Eigen::MatrixXd& basis) {
    return Extended(Eigen::HouseholderQR<Extended>(basis.cast<long double>()).householderQ() *
                    Extended::Identity(basis.rows(), basis.cols()));
  };
  const Extended left = orthonormal(test::random_basis(rows, columns, seed));
  const Extended right = orthonormal(test::random_basis(columns, columns, seed + 1));
  return (left * values.cast<long double>().asDiagonal() * right.transpose()).cast<double>();
}

/// The smallest singular value of the matrix as it is stored, in extended precision.
double exact_smallest(const Eigen::MatrixXd& j) {
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::JacobiSVD<Extended> svd(j.cast<long double>());
  return static_cast<double>(svd.singularValues().tail(1)(0));
}

TEST(SingularTriplets, KeepFiveDigitsWhereTheEigenvaluesOfTheSquareLoseAll) {
  for (const int columns : {8, 40}) {
    const Eigen::MatrixXd j = with_singular_values(steep_values(columns), 2 * columns, 31);
    const double sigma = exact_smallest(j);
    ASSERT_NEAR(sigma, 1e-9, 1e-12) << "the matrix is not the one that is meant";
    const SingularTriplets triplets = smallest_singular_triplets(test::to_petsc(j), 2);
    EXPECT_NEAR(triplets.values[0], sigma, 5e-5 * sigma) << columns;  // half a unit of the fifth digit
    EXPECT_NEAR(triplets.values[1], 1.0, 20.0 * epsilon * 1e3) << columns;

    const Eigenpairs square = smallest_eigenpairs(test::to_petsc(j.transpose() * j), {.count = 2});
    const double lost = std::sqrt(std::abs(square.values[0]));
    EXPECT_GT(std::abs(lost - sigma), 100.0 * sigma) << "J'J found the small singular value after all: " << lost;
    EXPECT_NEAR(square.values[1], 1.0, 20.0 * epsilon * 1e6) << columns;
  }
}

TEST(SingularTriplets, AreTriplets) {
  const Eigen::MatrixXd j = with_singular_values(steep_values(40), 90, 41);
  const SingularTriplets triplets = smallest_singular_triplets(test::to_petsc(j), 5);
  const double rounding = 50.0 * epsilon * j.norm();
  for (int n = 0; n < 5; ++n) {
    const double sigma = triplets.values[static_cast<std::size_t>(n)];
    const Eigen::VectorXd residual = j * triplets.right.col(n) - sigma * triplets.left.col(n);
    EXPECT_LT(residual.norm(), rounding) << n;
    EXPECT_NEAR(triplets.residuals[static_cast<std::size_t>(n)], residual.norm(), rounding) << n;
    EXPECT_LT((j.transpose() * triplets.left.col(n) - sigma * triplets.right.col(n)).norm(), rounding) << n;
    EXPECT_NEAR(sigma, steep_values(40)(n), rounding) << n;
    Eigen::Index largest = 0;
    triplets.right.col(n).cwiseAbs().maxCoeff(&largest);
    EXPECT_GT(triplets.right(largest, n), 0.0) << n;
  }
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(5, 5);
  EXPECT_LT((triplets.right.transpose() * triplets.right - one).norm(), 1e-13);
  EXPECT_LT((triplets.left.transpose() * triplets.left - one).norm(), 1e-13);
}

TEST(SingularTriplets, ExactlySingularAndSquare) {
  Eigen::MatrixXd j = with_singular_values(steep_values(20), 20, 51);
  j.col(7) = 2.0 * j.col(3);
  const SingularTriplets triplets = smallest_singular_triplets(test::to_petsc(j), 1);
  EXPECT_LT(triplets.values[0], 20.0 * epsilon * j.norm());
  EXPECT_LT((j * triplets.right.col(0)).norm(), 20.0 * epsilon * j.norm());
}

TEST(SingularTriplets, SameBitsOnRepeat) {
  const auto j = test::to_petsc(with_singular_values(steep_values(30), 60, 61));
  const SingularTriplets first = smallest_singular_triplets(j, 3);
  const SingularTriplets second = smallest_singular_triplets(j, 3);
  EXPECT_EQ(first.values, second.values);
  EXPECT_TRUE(first.right == second.right);
  EXPECT_TRUE(first.left == second.left);
}

TEST(SingularTriplets, MisuseAndNotFinite) {
  Eigen::MatrixXd j = with_singular_values(steep_values(6), 12, 71);
  EXPECT_THROW(static_cast<void>(smallest_singular_triplets(test::to_petsc(j), 0)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(smallest_singular_triplets(test::to_petsc(j), 7)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(smallest_singular_triplets(test::to_petsc(j.transpose()), 1)), core::MisuseError);
  j(4, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(smallest_singular_triplets(test::to_petsc(j), 1)), core::NotFiniteError);
}

}  // namespace
}  // namespace orbweaver::spectrum::singular_triplets_test
