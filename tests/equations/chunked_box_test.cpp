#include "chunked_box.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::equations {
namespace {

/// Random numbers for every part of the scheme, and the same as one dense matrix.
struct Problem {
  int dimension, cells, borders, stride;
  std::vector<double> blocks, columns, rows, corner;
  ChunkedBox::Matrices matrices{};
  Eigen::MatrixXd dense;

  Problem(int d, int m, int b) : dimension(d), cells(m), borders(b), stride(m + 4) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    const auto random = [&](int count, double scale) {
      std::vector<double> out(static_cast<std::size_t>(count));
      for (double& v : out) v = scale * normal(generator);
      return out;
    };
    blocks = random(d * d * m, 0.3);
    columns = random(b * d * stride, 1.0);
    rows = random(b * d * stride, 1.0);
    corner = random(b * b, 1.0);
    matrices = {m, stride, blocks.data(), columns.data(), rows.data(), corner.data(), b, {}, {}};
    matrices.left = Eigen::MatrixXd::Random(d, d);
    matrices.right = Eigen::MatrixXd::Random(d, d);
    const int size = d * (m + 1) + b;
    dense = Eigen::MatrixXd::Zero(size, size);
    const auto at = [&](int i, int j) { return i * (m + 1) + j; };
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < m; ++j) {
        dense(at(i, j), at(i, j)) -= 1.0;
        dense(at(i, j), at(i, j + 1)) += 1.0;
        for (int l = 0; l < d; ++l)
          for (const int k : {j, j + 1})
            dense(at(i, j), at(l, k)) -= 0.5 * blocks[static_cast<std::size_t>((i * d + l) * m + j)];
        for (int p = 0; p < b; ++p)
          dense(at(i, j), d * (m + 1) + p) = columns[static_cast<std::size_t>((p * d + i) * stride + j)];
      }
      for (int l = 0; l < d; ++l) {
        dense(at(i, m), at(l, 0)) += matrices.left(i, l);
        dense(at(i, m), at(l, m)) += matrices.right(i, l);
      }
      for (int q = 0; q < b; ++q)
        for (int j = 0; j <= m; ++j)
          dense(d * (m + 1) + q, at(i, j)) = rows[static_cast<std::size_t>((q * d + i) * stride + j)];
    }
    for (int q = 0; q < b; ++q)
      for (int p = 0; p < b; ++p) dense(d * (m + 1) + q, d * (m + 1) + p) = corner[static_cast<std::size_t>(q * b + p)];
  }

  [[nodiscard]] double error_of(const ChunkedBox& box) const {
    const Eigen::VectorXd right = Eigen::VectorXd::Random(dense.rows());
    const Eigen::VectorXd wanted = dense.partialPivLu().solve(right);
    std::vector<double> x(static_cast<std::size_t>(dimension * stride + borders));
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j <= cells; ++j) x[static_cast<std::size_t>(i * stride + j)] = right(i * (cells + 1) + j);
    for (int p = 0; p < borders; ++p)
      x[static_cast<std::size_t>(dimension * stride + p)] = right(dimension * (cells + 1) + p);
    box.solve(x.data());
    double error = 0.0;
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j <= cells; ++j)
        error = std::max(error, std::abs(x[static_cast<std::size_t>(i * stride + j)] - wanted(i * (cells + 1) + j)));
    for (int p = 0; p < borders; ++p)
      error = std::max(
          error, std::abs(x[static_cast<std::size_t>(dimension * stride + p)] - wanted(dimension * (cells + 1) + p)));
    return error / wanted.lpNorm<Eigen::Infinity>();
  }
};

TEST(ChunkedBox, EqualsTheDenseSolve) {
  for (const int dimension : {2, 3, 4, 6})
    for (const int cells : {4, 8, 28})
      for (const int borders : {1, 2}) {
        const Problem problem(dimension, cells, borders);
        const auto box = ChunkedBox::of_dimension(dimension);
        box->factor(problem.matrices);
        EXPECT_LT(problem.error_of(*box), 1e-10) << dimension << " coordinates, " << cells << " cells, " << borders;
      }
}

TEST(ChunkedBox, FactorsAnew) {
  const auto box = ChunkedBox::of_dimension(4);
  const Problem large(4, 28, 2);
  const Problem small(4, 8, 1);
  for (const Problem* problem : {&large, &small, &large}) {
    box->factor(problem->matrices);
    EXPECT_LT(problem->error_of(*box), 1e-10);
  }
}

TEST(ChunkedBox, SingularSystemsAreRefused) {
  Problem problem(2, 8, 1);
  problem.matrices.left.setZero();
  problem.matrices.right.setZero();
  EXPECT_THROW(ChunkedBox::of_dimension(2)->factor(problem.matrices), core::NumericalError);
}

TEST(ChunkedBox, KnowsItsDimensions) { EXPECT_EQ(ChunkedBox::of_dimension(5), nullptr); }

}  // namespace
}  // namespace orbweaver::equations
