#pragma once

#include <vector>

#include <petscmat.h>
#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::loss {

/// The unknowns that stay free under a few linear conditions c . u = 0 (held orthogonal to the tangent, phase
/// condition, pinned period): u = Q x with Q an orthonormal basis of the complement, kept as Householder reflectors, so
/// that products cost O(conditions x unknowns) and u differs from x almost nowhere.
class Slice {
 public:
  /// `conditions`: unknowns x count, independent columns (count may be 0). Throws MisuseError if they are dependent.
  Slice(int unknowns, const Eigen::MatrixXd& conditions);

  /// The conditions as given: unknowns x count.
  [[nodiscard]] const Eigen::MatrixXd& conditions() const { return _given; }
  [[nodiscard]] int unknowns() const { return _unknowns; }
  [[nodiscard]] int free() const { return _unknowns - _conditions; }

  /// u = Q x.
  [[nodiscard]] Eigen::VectorXd expand(const Eigen::VectorXd& x) const;
  /// x = Q' u.
  [[nodiscard]] Eigen::VectorXd reduce(const Eigen::VectorXd& u) const;
  /// Q' H Q of a symmetric dense matrix (free x free).
  [[nodiscard]] core::Handle<Mat> reduce_symmetric(const core::Handle<Mat>& matrix) const;
  /// The same into an existing matrix of size free x free.
  void reduce_symmetric(const core::Handle<Mat>& matrix, const core::Handle<Mat>& out) const;
  /// J Q of a dense matrix (rows x free).
  [[nodiscard]] core::Handle<Mat> reduce_columns(const core::Handle<Mat>& matrix) const;

 private:
  int _unknowns;
  int _conditions;
  Eigen::MatrixXd _given;
  std::vector<Eigen::VectorXd> _reflectors;  // unit vectors v of I - 2 v v'
};

}  // namespace orbweaver::loss
