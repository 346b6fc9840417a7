#pragma once

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/spectrum/singular_triplets.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

struct TripletOptions {
  int count = 1;
  double tolerance = 1e-8;        ///< of the vectors, matrix-free; values are right to its square
  double inner_tolerance = 1e-9;  ///< of the solves inside
  bool multiple = false;          ///< look again beside those found, matrix-free: else a multiple value is found once
  /// Fewer than `count`: so many of the values are expected to be far below 2 pi / T, and sought first by inverse
  /// iteration, matrix-free. Nothing is taken for granted: what has not the residuals of a triplet is left to the
  /// search that finds the others.
  int nearly_flat = 0;
  int krylov_from = 120;       ///< smaller problems are solved by dense matrices (measured: docs/performance.md)
  core::Team* team = nullptr;  ///< ranks that divide the matrix-free way among them; then it is collective
};

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
