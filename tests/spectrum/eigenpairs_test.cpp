#include "orbweaver/spectrum/eigenpairs.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "spectrum/matrices.hpp"

namespace orbweaver::spectrum::eigenpairs_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Sizes on both sides of EigenOptions::lapack_below: LAPACK for the first two, shift-invert for the others.
const std::vector<int> sizes = {6, 24, 25, 120};

/// The given smallest eigenvalues, then values spread evenly in the logarithm from `from` to 1.
Eigen::VectorXd spectrum_of(const std::vector<double>& smallest, double from, int size) {
  Eigen::VectorXd values(size);
  const int rest = size - static_cast<int>(smallest.size());
  for (int n = 0; n < size; ++n) {
    const int above = n - static_cast<int>(smallest.size());
    values(n) = above < 0 ? smallest[static_cast<std::size_t>(n)] : std::pow(from, 1.0 - (above + 1.0) / rest);
  }
  return values;
}

Eigen::MatrixXd symmetric(const Eigen::VectorXd& values, unsigned seed) {
  const auto size = static_cast<int>(values.size());
  const Eigen::MatrixXd basis = test::random_basis(size, size, seed);
  const Eigen::MatrixXd matrix = basis * values.asDiagonal() * basis.transpose();
  return 0.5 * (matrix + matrix.transpose());
}

struct Case {
  std::string name;
  std::vector<double> smallest;
  double from;
};

class KnownSpectrum : public testing::TestWithParam<Case> {};

// The matrix in floating point has the spectrum up to a few eps |H| (Weyl), so that is the tolerance for values.
// Vectors come from solves with H + 1e-8 |H|, whose rounding leaves residuals of up to 1e-10 |H|.
TEST_P(KnownSpectrum, SmallestPairs) {
  for (const int size : sizes) {
    SCOPED_TRACE("size " + std::to_string(size));
    const Eigen::VectorXd wanted = spectrum_of(GetParam().smallest, GetParam().from, size);
    const Eigen::MatrixXd h = symmetric(wanted, 7u + static_cast<unsigned>(size));
    const double rounding = 20.0 * epsilon * h.norm();
    const Eigenpairs pairs = smallest_eigenpairs(test::to_petsc(h), {.count = 4});
    ASSERT_EQ(pairs.values.size(), 4u);
    ASSERT_EQ(pairs.residuals.size(), 4u);
    for (int n = 0; n < 4; ++n) {
      const double value = pairs.values[static_cast<std::size_t>(n)];
      const Eigen::VectorXd v = pairs.vectors.col(n);
      EXPECT_NEAR(value, wanted(n), rounding) << "eigenvalue " << n;
      const double residual = (h * v - value * v).norm();
      EXPECT_LT(residual, 1e-10 * h.norm()) << "eigenvalue " << n;
      EXPECT_NEAR(pairs.residuals[static_cast<std::size_t>(n)], residual, rounding) << "eigenvalue " << n;
      EXPECT_GT(
          v(std::distance(v.begin(), std::max_element(v.begin(), v.end(),
                                                      [](double a, double b) { return std::abs(a) < std::abs(b); }))),
          0.0);
    }
    EXPECT_LT((pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(4, 4)).norm(), 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(Eigenpairs, KnownSpectrum,
                         testing::Values(Case{"WellConditioned", {0.1, 0.2, 0.3, 0.4}, 0.5},
                                         Case{"Condition1e8", {1e-8, 1e-6, 2e-5, 5e-4}, 1e-3},
                                         Case{"Condition1e14", {1e-14, 3e-9, 1e-7, 4e-6}, 1e-3},
                                         Case{"ExactlySingular", {0.0, 1e-5, 2e-4, 5e-4}, 1e-3},
                                         Case{"DoubleZero", {0.0, 0.0, 1e-6, 3e-6}, 1e-4},
                                         Case{"NearlyDoubleZero", {1e-13, 2e-13, 1e-6, 3e-6}, 1e-4},
                                         Case{"OneNegativeByRounding", {-1e-15, 1e-6, 3e-6, 1e-5}, 1e-4}),
                         [](const auto& tested) { return tested.param.name; });

// A shift too close to 0 reports wrong third and fourth values as converged for such a matrix.
TEST(Eigenpairs, ThirdAndFourthBesideAnExactDoubleKernel) {
  constexpr int size = 80;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, size);
  h.bottomRightCorner(size - 2, size - 2) = symmetric(spectrum_of({2e-7, 5e-7}, 1e-3, size - 2), 3);
  const Eigenpairs pairs = smallest_eigenpairs(test::to_petsc(h), {.count = 4});
  EXPECT_NEAR(pairs.values[0], 0.0, 20.0 * epsilon * h.norm());
  EXPECT_NEAR(pairs.values[1], 0.0, 20.0 * epsilon * h.norm());
  EXPECT_NEAR(pairs.values[2], 2e-7, 20.0 * epsilon * h.norm());
  EXPECT_NEAR(pairs.values[3], 5e-7, 20.0 * epsilon * h.norm());
}

TEST(Eigenpairs, ScaleOfTheMatrixDoesNotMatter) {
  const Eigen::MatrixXd h = symmetric(spectrum_of({1e-9, 2e-6}, 1e-3, 60), 5);
  for (const double scale : {1e-60, 1e-12, 1e12, 1e60}) {
    const Eigenpairs pairs = smallest_eigenpairs(test::to_petsc(scale * h), {.count = 2});
    EXPECT_NEAR(pairs.values[0] / scale, 1e-9, 20.0 * epsilon * h.norm()) << scale;
    EXPECT_NEAR(pairs.values[1] / scale, 2e-6, 20.0 * epsilon * h.norm()) << scale;
  }
}

TEST(Eigenpairs, OneByOneAndAllPairs) {
  EXPECT_EQ(smallest_eigenpairs(test::to_petsc(Eigen::MatrixXd::Constant(1, 1, 3.0)), {}).values.front(), 3.0);
  const Eigen::VectorXd wanted = spectrum_of({}, 1e-2, 30);
  const Eigenpairs pairs = smallest_eigenpairs(test::to_petsc(symmetric(wanted, 11)), {.count = 30});
  for (int n = 0; n < 30; ++n) EXPECT_NEAR(pairs.values[static_cast<std::size_t>(n)], wanted(n), 1e-14);
}

TEST(Eigenpairs, SameBitsOnRepeat) {
  for (const int size : sizes) {
    const auto h = test::to_petsc(symmetric(spectrum_of({1e-12, 2e-12, 1e-5}, 1e-3, size), 13));
    const Eigenpairs first = smallest_eigenpairs(h, {.count = 3});
    static_cast<void>(smallest_eigenpairs(test::to_petsc(symmetric(spectrum_of({}, 0.1, 40), 17)), {.count = 2}));
    const Eigenpairs second = smallest_eigenpairs(h, {.count = 3});
    EXPECT_EQ(first.values, second.values) << size;
    EXPECT_EQ(first.residuals, second.residuals) << size;
    EXPECT_TRUE(first.vectors == second.vectors) << size;
  }
}

TEST(Eigenpairs, MisuseAndNotFinite) {
  for (const int size : {6, 60}) {
    Eigen::MatrixXd h = symmetric(spectrum_of({}, 0.1, size), 19);
    EXPECT_THROW(static_cast<void>(smallest_eigenpairs(test::to_petsc(h), {.count = 0})), core::MisuseError);
    EXPECT_THROW(static_cast<void>(smallest_eigenpairs(test::to_petsc(h), {.count = size + 1})), core::MisuseError);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      h(2, 3) = h(3, 2) = bad;
      EXPECT_THROW(static_cast<void>(smallest_eigenpairs(test::to_petsc(h), {.count = 1})), core::NotFiniteError);
    }
  }
}

TEST(Eigenpairs, ZeroMatrix) {
  for (const int size : {6, 60}) {
    const Eigenpairs pairs = smallest_eigenpairs(test::to_petsc(Eigen::MatrixXd::Zero(size, size)), {.count = 2});
    EXPECT_EQ(pairs.values[0], 0.0) << size;
    EXPECT_EQ(pairs.values[1], 0.0) << size;
    EXPECT_NEAR(pairs.vectors.col(0).norm(), 1.0, 1e-12) << size;
  }
}

}  // namespace
}  // namespace orbweaver::spectrum::eigenpairs_test
