#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "orbweaver/numerics/eigenvalues.hpp"

namespace orbweaver::numerics::eigenvalues_test {
namespace {

// 2 cos(2 pi 0.8853) and 2 cos(2 pi 0.2), each twice to rounding. Eigen's QR iteration of real matrices does not end
// on it.
Eigen::Matrix4d with_double_eigenvalues() {
  Eigen::Matrix4d matrix;
  matrix << 0x1.12c61180d3c7p+0, -0x1.ba3cc0a664e4p-7, -0x1.762422711eecp-4, -0x1.bac73e543e2afp-2,  //
      -0x1.ba3cc0a61364p-7, 0x1.0c232d6b738a8p+0, -0x1.bac73e54402afp-2, 0x1.76242271129c8p-4,       //
      -0x1.7624227115de8p-4, -0x1.bac73e543f51dp-2, 0x1.13e336f7bca64p+0, 0x1.d15aa2713c5p-8,        //
      -0x1.bac73e543eda8p-2, 0x1.762422711b79p-4, 0x1.d15aa271147ep-8, 0x1.0b0607f4790f6p+0;
  return matrix;
}

double residual(const Eigen::MatrixXd& matrix, const Eigensystem& system) {
  return (matrix * system.vectors - system.vectors * system.values.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST(Eigenvalues, AreFoundWhereTheIterationTurnsInACircle) {
  const Eigen::Matrix4d matrix = with_double_eigenvalues();
  const std::optional<Eigensystem> system = eigensystem(matrix, true);
  ASSERT_TRUE(system);
  EXPECT_EQ(system->values.sum().imag(), 0.0) << "no conjugates";
  Eigen::Vector4d values = system->values.real();
  std::sort(values.begin(), values.end());
  const double turn = 2.0 * std::acos(-1.0);
  const Eigen::Vector4d expected{2 * std::cos(0.2 * turn), 2 * std::cos(0.2 * turn), 2 * std::cos(0.8853 * turn),
                                 2 * std::cos(0.8853 * turn)};
  EXPECT_LT((values - expected).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT(residual(matrix, *system), 1e-14);
}

TEST(Eigenvalues, OfAnyMatrixFitTheirVectors) {
  for (const int n : {1, 2, 7, 40}) {
    const Eigen::MatrixXd turned = orthogonal_in_general_position(n);
    EXPECT_LT((turned.transpose() * turned - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-14 * n) << n;
    Eigen::MatrixXd matrix = turned * Eigen::VectorXd::LinSpaced(n, 1.0, 2.0).asDiagonal() * turned;
    const std::optional<Eigensystem> system = eigensystem(matrix, true);
    ASSERT_TRUE(system) << n;
    EXPECT_LT(residual(matrix, *system), 1e-13) << n;
    EXPECT_EQ(eigensystem(matrix, false)->vectors.size(), 0) << n;
  }
}

TEST(Eigenvalues, OfWhatIsNotFiniteAreNone) {
  EXPECT_FALSE(eigensystem(Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::infinity()), false));
  EXPECT_FALSE(eigensystem(Eigen::MatrixXd::Constant(1, 1, std::nan("")), false));
}

}  // namespace
}  // namespace orbweaver::numerics::eigenvalues_test
