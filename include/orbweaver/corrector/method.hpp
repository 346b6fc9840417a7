#pragma once

#include <string_view>

namespace orbweaver::corrector {

/// The solvers: TAO types but for the first three.
enum class Method {
  automatic,      ///< branches: collocation where it applies; single loops: newton-krylov for large problems, or nls
  collocation,    ///< branches: on their fundamental domain (layer continuation), or an error; single loops: automatic
  newton_krylov,  ///< Newton on the projected residual, matrix-free, GMRES with the box scheme (not a TAO type)
  brgn,           ///< regularised Gauss-Newton on the assembled Jacobian
  nls,            ///< Newton with line search on the assembled Hessian
  ntr,            ///< Newton with trust region on the assembled Hessian
  lmvm,           ///< limited-memory quasi-Newton
  rprop,          ///< the paper's: step sizes a parameter from the signs of the gradient
  rprop_extrapolated,  ///< the same with the paper's line search along the direction of the last epochs
};

/// Name as in a scene ("automatic", "collocation", "newton-krylov", "brgn", "nls", "ntr", "lmvm", "rprop",
/// "rprop-extrapolated") and back. `method_of` throws core::InputError naming the known ones.
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] Method method_of(std::string_view name);
[[nodiscard]] bool is_second_order(Method method);

}  // namespace orbweaver::corrector
