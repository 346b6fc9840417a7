#pragma once

#include <vector>

#include <Eigen/Dense>

namespace orbweaver::systems {

/// z -> matrix z + offset, on phase space.
struct AffineMap {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd offset;

  AffineMap() = default;
  /// A linear map. Implicit: where a map is expected, its matrix is one.
  template <class Derived>
  AffineMap(const Eigen::MatrixBase<Derived>& linear) : matrix(linear), offset(Eigen::VectorXd::Zero(matrix.rows())) {}
  AffineMap(Eigen::MatrixXd linear, Eigen::VectorXd constant);

  [[nodiscard]] static AffineMap identity(int dimension);
  [[nodiscard]] int dimension() const { return static_cast<int>(matrix.rows()); }
  [[nodiscard]] bool is_linear() const { return offset.isZero(0.0); }
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& z) const { return matrix * z + offset; }
  [[nodiscard]] AffineMap inverse() const;
  /// True if both are the same map modulo whole turns of the coordinates in `angles`. Only there offsets are compared:
  /// two maps of one finite group with the same matrix differ by a translation of finite order, which other coordinates
  /// do not have.
  [[nodiscard]] bool is_same(const AffineMap& other, const std::vector<int>& angles) const;
};

/// `after` applied after `before`.
[[nodiscard]] AffineMap operator*(const AffineMap& after, const AffineMap& before);

}  // namespace orbweaver::systems
