#pragma once

namespace orbweaver::equations {

/// What stands for the inverse of the derivative while the equations of a fundamental domain are solved.
enum class Preconditioner {
  box,         ///< the box scheme: better than the next beside a narrow gap between families (mu = 0.001, 13 turns)
  fitted_box,  ///< the same, but follows turns of the linearised flow over a cell: beside a fast motion
  exact,       ///< the derivative itself, O(n^3) for n unknowns: beside motions that cells do not resolve
  krylov,      ///< the same as far as rounding allows, by GMRES around the box: beside gaps, for any number of unknowns
};
[[nodiscard]] constexpr Preconditioner last_of(Preconditioner) { return Preconditioner::krylov; }

/// Unknowns up to which `exact` is affordable: some seconds.
inline constexpr int exact_unknowns = 2048;

}  // namespace orbweaver::equations
