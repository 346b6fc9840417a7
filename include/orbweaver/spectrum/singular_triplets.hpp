#pragma once

#include <vector>

#include <petscmat.h>
#include <Eigen/Dense>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"

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

struct TripletOptions {
  int count = 1;
  double tolerance = 1e-8;        ///< of the vectors, matrix-free; values are right to its square
  double inner_tolerance = 1e-9;  ///< of the solves inside
  bool multiple = false;          ///< look again beside those found, matrix-free: else a multiple value is found once
  int krylov_from = 120;          ///< smaller problems are solved by dense matrices (measured: docs/performance.md)
  core::Team* team = nullptr;     ///< ranks that divide the matrix-free way among them; then it is collective
};

/// The `count` smallest singular triplets of a dense matrix with at least as many rows as columns, by SLEPc's SVD on
/// the triangular factor of J. Unlike the eigenvalues of J'J they keep their digits down to about 1e-16 |J|. Throws
/// MisuseError for count < 1 or > columns or fewer rows than columns; NumericalError for a matrix that is not finite.
[[nodiscard]] SingularTriplets smallest_singular_triplets(const core::Handle<Mat>& matrix, int count);

/// The smallest singular triplets of a loop's J over the `unknowns` on the `slice` (J restricted to what the slice
/// leaves free); v holds unknowns. From `krylov_from` unknowns on matrix-free, in O(K log K) time and O(K) memory, if
/// the loop equations are square; else by the dense matrix. The slice should hold what is known to be flat at an orbit:
/// the time shift, where the unknowns contain it, and the family's tangent, where they contain the period. Throws
/// MisuseError for count < 1 or > free unknowns; NumericalError where triplets do not converge.
[[nodiscard]] SingularTriplets smallest_singular_triplets(const systems::System& system, const loop::Loop& loop,
                                                          const loss::Unknowns& unknowns, const loss::Slice& slice,
                                                          const TripletOptions& options);

/// The matrix-free way: Lanczos bidiagonalisation (SLEPc's SVD) of the inverse that GMRES with the box scheme gives
/// (docs/mathematics.md, "Singular triplets"). The equations must be factored; the solves are divided among their team.
[[nodiscard]] SingularTriplets smallest_singular_triplets(const equations::LoopEquations& equations,
                                                          const TripletOptions& options);

/// The smallest eigenpairs of the Gauss-Newton Hessian H = 2 J'J on the slice, from the triplets: values 2 sigma^2,
/// which keeps their digits below 1e-16 |H|; vectors hold unknowns.
[[nodiscard]] Eigenpairs smallest_eigenpairs(const systems::System& system, const loop::Loop& loop,
                                             const loss::Unknowns& unknowns, const loss::Slice& slice,
                                             const TripletOptions& options);

}  // namespace orbweaver::spectrum
