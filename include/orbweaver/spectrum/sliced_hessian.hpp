#pragma once

#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::spectrum {

/// The Gauss-Newton Hessian of a loop on a slice, factored once (Cholesky): gives the Newton step and the flat
/// direction through the slice's normal, each for the cost of a triangular solve.
class SlicedHessian {
 public:
  /// Assembles and factors. Where rounding makes H indefinite a multiple of the identity, from 1e-15 |H| upwards, is
  /// added; throws NumericalError if 1e-9 |H| does not suffice.
  SlicedHessian(const loss::Linearization& linearization, const loss::Unknowns& unknowns, const loss::Slice& slice);

  /// u in the slice with minimal |R + J u|: what Newton's method adds to the loop.
  [[nodiscard]] Eigen::VectorXd newton_step() const;

  /// The t with n . t = |n|^2 along which the loss is flattest (t' H t minimal), scaled to unit length; `normal` is the
  /// slice's condition. At an orbit this is the zero eigenvector of H (paper, section II B).
  [[nodiscard]] Eigen::VectorXd flat_direction(const Eigen::VectorXd& normal) const;

  /// What was added to the diagonal to factor (0 in regular cases).
  [[nodiscard]] double shift() const { return _shift; }

 private:
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;
  void factor(const core::Handle<Mat>& reduced);

  loss::Slice _slice;
  core::Handle<Mat> _hessian;
  core::Handle<Mat> _factor;
  Eigen::VectorXd _gradient;
  double _shift = 0.0;
};

}  // namespace orbweaver::spectrum
