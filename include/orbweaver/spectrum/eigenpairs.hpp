#pragma once

#include <vector>

#include <petscmat.h>
#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::spectrum {

/// Eigenpairs of a symmetric matrix, smallest eigenvalue first.
struct Eigenpairs {
  std::vector<double> values;
  Eigen::MatrixXd vectors;        ///< one a column, unit length, sign fixed by its largest entry
  std::vector<double> residuals;  ///< |H v - lambda v|
};

struct EigenOptions {
  int count = 1;
  double tolerance = 1e-12;  ///< relative to |H|
  int lapack_below = 24;     ///< smaller matrices are solved whole (measured: docs/performance.md)
};

/// The smallest eigenpairs of a symmetric positive semidefinite dense matrix by SLEPc: shift-invert just below zero, at
/// -1e-8 |H|, which is a safe distance for a singular H (closer to 0 wrong values are reported as converged). Values
/// below about 1e-16 |H| are rounding. Overridable under the options prefix `spectrum_eps_`.
/// Throws NumericalError if fewer than `count` pairs converge; MisuseError for count < 1 or > size.
[[nodiscard]] Eigenpairs smallest_eigenpairs(const core::Handle<Mat>& matrix, const EigenOptions& options);

}  // namespace orbweaver::spectrum
