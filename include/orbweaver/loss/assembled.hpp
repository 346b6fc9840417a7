#pragma once

#include <petscmat.h>

#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::loss {

/// J as a dense PETSc matrix on PETSC_COMM_SELF, (dimension N) x unknowns. Cost O(N dimension^2 unknowns): for small K,
/// for least-squares solvers that want it, and as the reference of the matrix-free form.
[[nodiscard]] core::Handle<Mat> assemble_jacobian(const Linearization& linearization, const Unknowns& unknowns);

/// H as a dense symmetric PETSc matrix, unknowns x unknowns. Sums over nodes of products of two modes are sums and
/// differences of Fourier sums of the nodal d x d blocks, so that the cost is O(d^2 N log N + unknowns^2), whatever N.
[[nodiscard]] core::Handle<Mat> assemble_hessian(const Linearization& linearization, const Unknowns& unknowns,
                                                 Curvature curvature);

}  // namespace orbweaver::loss
