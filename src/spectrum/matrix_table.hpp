#pragma once

#include <Eigen/Dense>

namespace orbweaver::spectrum {

/// Many small square matrices of one size D (or Eigen::Dynamic), each a column of `table`, column by column.
template <int D>
[[nodiscard]] Eigen::Map<const Eigen::Matrix<double, D, D>> matrix_in(const Eigen::MatrixXd& table, Eigen::Index n,
                                                                      Eigen::Index size) {
  return {table.col(n).data(), size, size};
}

template <int D>
[[nodiscard]] Eigen::Map<Eigen::Matrix<double, D, D>> matrix_in(Eigen::MatrixXd& table, Eigen::Index n,
                                                                Eigen::Index size) {
  return {table.col(n).data(), size, size};
}

}  // namespace orbweaver::spectrum
