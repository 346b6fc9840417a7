#pragma once

#include <algorithm>
#include <random>

#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::test {

/// An orthonormal basis (rows x columns) that depends on the seed alone.
inline Eigen::MatrixXd random_basis(int rows, int columns, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = uniform(random);
  return Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).householderQ() * Eigen::MatrixXd::Identity(rows, columns);
}

inline core::Handle<Mat> to_petsc(const Eigen::MatrixXd& matrix) {
  core::Handle<Mat> out = loss::create_dense(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()));
  loss::with_dense_array(out, [&](loss::DenseMap map) { map = matrix; });
  return out;
}

inline Eigen::MatrixXd to_dense(const core::Handle<Mat>& matrix) {
  Eigen::MatrixXd out;
  loss::with_dense_array(matrix, [&](loss::DenseMap map) { out = map; });
  return out;
}

}  // namespace orbweaver::test
