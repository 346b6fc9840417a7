#pragma once

#include <memory>

#include <petscmat.h>

#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::loss {

/// J and H as MATSHELL: products in O(N log N), nothing stored but the nodal blocks. The matrices keep what they need.
[[nodiscard]] core::Handle<Mat> shell_jacobian(std::shared_ptr<const Linearization> linearization,
                                               std::shared_ptr<const Unknowns> unknowns);
[[nodiscard]] core::Handle<Mat> shell_hessian(std::shared_ptr<const Linearization> linearization,
                                              std::shared_ptr<const Unknowns> unknowns, Curvature curvature);

}  // namespace orbweaver::loss
