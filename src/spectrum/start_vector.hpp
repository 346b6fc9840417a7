#pragma once

#include <cstddef>
#include <vector>

#include <petscvec.h>
#include <slepcbv.h>
#include <Eigen/Dense>

#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::spectrum {

/// The fixed vector that every Krylov solver starts from, so that results depend on the matrix alone; others by their
/// numbers, for blocks of them.
[[nodiscard]] core::Handle<Vec> start_vector(int size, int number = 0);

/// Gives a solver's basis a random generator with a fixed seed (PETSc's default seed depends on the rank).
void seed_basis(BV basis);

/// The vector or its opposite, whichever has its largest entry (the first among equals) positive.
[[nodiscard]] Eigen::VectorXd with_fixed_sign(const Eigen::VectorXd& vector);

/// Indices that sort `values`, smallest first, equal ones in their order.
[[nodiscard]] std::vector<std::size_t> ascending(const std::vector<double>& values);

}  // namespace orbweaver::spectrum
