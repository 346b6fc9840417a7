#pragma once

#include <vector>

#include <petscmat.h>
#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::spectrum {

/// Singular triplets J v = sigma u, smallest sigma first.
struct SingularTriplets {
  std::vector<double> values;
  Eigen::MatrixXd right;               ///< v, one a column (columns of J x count), sign fixed by its largest entry
  Eigen::MatrixXd left;                ///< u, one a column (rows of J x count)
  std::vector<double> residuals;       ///< |J v - sigma u|
  std::vector<double> left_residuals;  ///< |J' u - sigma v|
  int inner_iterations = 0;            ///< of GMRES; 0 where the matrix was dense
};

/// The `count` smallest singular triplets of a dense matrix with at least as many rows as columns, by SLEPc's SVD on
/// the triangular factor of J. Unlike the eigenvalues of J'J they keep their digits down to about 1e-16 |J|. Throws
/// MisuseError for count < 1 or > columns or fewer rows than columns; NumericalError for a matrix that is not finite.
[[nodiscard]] SingularTriplets smallest_singular_triplets(const core::Handle<Mat>& matrix, int count);

}  // namespace orbweaver::spectrum
