#include "orbweaver/loss/slice.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss::slice_test {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, std::uint64_t seed) {
  const std::vector<double> values =
      test::random_values(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), seed);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, columns);
}

Eigen::MatrixXd basis_of(const Slice& slice) {
  Eigen::MatrixXd q(slice.unknowns(), slice.free());
  for (int n = 0; n < slice.free(); ++n) q.col(n) = slice.expand(Eigen::VectorXd::Unit(slice.free(), n));
  return q;
}

core::Handle<Mat> petsc_matrix(const Eigen::MatrixXd& values) {
  core::Handle<Mat> matrix = create_dense(static_cast<int>(values.rows()), static_cast<int>(values.cols()));
  with_dense_array(matrix, [&](DenseMap map) { map = values; });
  return matrix;
}

Eigen::MatrixXd values_of(const core::Handle<Mat>& matrix) {
  Eigen::MatrixXd values;
  with_dense_array(matrix, [&](DenseMap map) { values = map; });
  return values;
}

// Among them unit vectors, one that is the first axis already, and one that is opposite to it.
std::vector<Eigen::MatrixXd> condition_sets() {
  std::vector<Eigen::MatrixXd> sets{Eigen::MatrixXd(12, 0),           random_matrix(12, 1, 1),
                                    1e-8 * random_matrix(12, 2, 2),   random_matrix(12, 5, 3),
                                    random_matrix(12, 11, 4),         Eigen::MatrixXd::Identity(12, 3),
                                    -Eigen::MatrixXd::Identity(12, 2)};
  sets.emplace_back(Eigen::MatrixXd::Identity(12, 12).rightCols(2));
  Eigen::MatrixXd nearly = random_matrix(12, 2, 5);
  nearly.col(1) = nearly.col(0) + 1e-6 * nearly.col(1);
  sets.push_back(nearly);
  return sets;
}

TEST(Slice, BasisIsOrthonormalAndOrthogonalToTheConditions) {
  for (const Eigen::MatrixXd& c : condition_sets()) {
    const Slice slice(12, c);
    ASSERT_EQ(slice.free(), 12 - c.cols());
    EXPECT_EQ(slice.conditions(), c);
    const Eigen::MatrixXd q = basis_of(slice);
    EXPECT_LT((q.transpose() * q - Eigen::MatrixXd::Identity(q.cols(), q.cols())).norm(), 1e-14);
    for (Eigen::Index n = 0; n < c.cols(); ++n) EXPECT_LT((q.transpose() * c.col(n)).norm(), 1e-14 * c.col(n).norm());
  }
}

TEST(Slice, ExpandAndReduceAreInverse) {
  for (const Eigen::MatrixXd& c : condition_sets()) {
    const Slice slice(12, c);
    const Eigen::MatrixXd q = basis_of(slice);
    const Eigen::VectorXd x = random_matrix(slice.free(), 1, 6);
    EXPECT_LT((slice.reduce(slice.expand(x)) - x).norm(), 1e-14);
    const Eigen::VectorXd u = random_matrix(12, 1, 7);
    EXPECT_LT((slice.reduce(u) - q.transpose() * u).norm(), 1e-14);
    EXPECT_LT((slice.expand(slice.reduce(u)) - q * (q.transpose() * u)).norm(), 1e-14);
  }
}

TEST(Slice, WithoutConditionsIsTheIdentity) {
  const Slice slice(4, Eigen::MatrixXd(4, 0));
  const Eigen::Vector4d u(1.0, 2.0, 3.0, 4.0);
  EXPECT_EQ(slice.expand(u), u);
  EXPECT_EQ(slice.reduce(u), u);
}

TEST(Slice, ReducesMatricesAsTheBasisDoes) {
  for (const Eigen::MatrixXd& c : condition_sets()) {
    const Slice slice(12, c);
    const Eigen::MatrixXd q = basis_of(slice);
    const Eigen::MatrixXd half = random_matrix(12, 12, 8);
    const Eigen::MatrixXd h = half + half.transpose();
    const Eigen::MatrixXd reduced = values_of(slice.reduce_symmetric(petsc_matrix(h)));
    EXPECT_LT((reduced - q.transpose() * h * q).norm(), 1e-14 * h.norm());
    const core::Handle<Mat> room = petsc_matrix(random_matrix(slice.free(), slice.free(), 16));
    slice.reduce_symmetric(petsc_matrix(h), room);
    EXPECT_EQ(values_of(room), reduced) << "whatever the matrix held before";
    const Eigen::MatrixXd j = random_matrix(20, 12, 9);
    EXPECT_LT((values_of(slice.reduce_columns(petsc_matrix(j))) - j * q).norm(), 1e-14 * j.norm());
  }
}

TEST(Slice, LeavesTheMatrixItReducesAlone) {
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(5, 5);
  const core::Handle<Mat> matrix = petsc_matrix(h);
  static_cast<void>(Slice(5, random_matrix(5, 2, 10)).reduce_symmetric(matrix));
  static_cast<void>(Slice(5, random_matrix(5, 2, 10)).reduce_columns(matrix));
  EXPECT_EQ(values_of(matrix), h);
}

// One condition changes only what it touches: u differs from x almost nowhere when the condition is sparse.
TEST(Slice, LeavesUntouchedUnknownsAlone) {
  const Slice slice(6, Eigen::VectorXd::Unit(6, 5));
  const Eigen::VectorXd u = slice.expand((Eigen::VectorXd(5) << 1.0, 2.0, 3.0, 4.0, 5.0).finished());
  EXPECT_NEAR(u(5), 0.0, 1e-15);
  for (int n = 1; n < 5; ++n) EXPECT_EQ(u(n), n) << "unknown " << n << " is x(" << n - 1 << ")";
}

TEST(SliceMisuse, DependentConditionsAreRefused) {
  Eigen::MatrixXd twice = random_matrix(6, 2, 11);
  twice.col(1) = -3.0 * twice.col(0);
  EXPECT_THROW(Slice(6, twice), core::MisuseError);
  Eigen::MatrixXd sum = random_matrix(6, 3, 12);
  sum.col(2) = sum.col(0) - 2.0 * sum.col(1);
  EXPECT_THROW(Slice(6, sum), core::MisuseError);
  EXPECT_THROW(Slice(6, Eigen::MatrixXd::Zero(6, 1)), core::MisuseError);
  EXPECT_THROW(Slice(6, Eigen::MatrixXd::Constant(6, 1, std::numeric_limits<double>::quiet_NaN())), core::MisuseError);
}

TEST(SliceMisuse, WrongSizesAreRefused) {
  EXPECT_THROW(Slice(6, random_matrix(5, 1, 13)), core::MisuseError);
  EXPECT_THROW(Slice(3, random_matrix(3, 3, 14)), core::MisuseError) << "nothing is left free";
  const Slice slice(6, random_matrix(6, 2, 15));
  EXPECT_THROW(static_cast<void>(slice.expand(Eigen::VectorXd::Zero(6))), core::MisuseError);
  EXPECT_THROW(static_cast<void>(slice.reduce(Eigen::VectorXd::Zero(4))), core::MisuseError);
  EXPECT_THROW(static_cast<void>(slice.reduce_symmetric(create_dense(5, 5))), core::MisuseError);
  EXPECT_THROW(static_cast<void>(slice.reduce_symmetric(create_dense(7, 6))), core::MisuseError);
  EXPECT_THROW(slice.reduce_symmetric(create_dense(6, 6), create_dense(6, 6)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(slice.reduce_columns(create_dense(6, 5))), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loss::slice_test
