#pragma once

#include <vector>

#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/spectrum/loop_triplets.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// A direction in which an orbit is nearly flat besides its time shift and its family: J v = sigma u.
struct OffBranchTriplet {
  double singular_value = 0.0;  ///< sigma; the paper's off-branch eigenvalue is 2 sigma^2
  loop::Tangent direction;      ///< v: |v| = 1
  std::vector<int> signs;       ///< under each generator of the isotropy: +1 kept, -1 broken; empty: not split
  double residual = 0.0;        ///< |J v - sigma u|
  double left_residual = 0.0;   ///< |J' u - sigma v|, both on the slice
};

/// The `options.count` smallest within one sector of an isotropy, smallest first: perturbations of the loop that keep
/// or flip the sign under each of its generators as `signs` says (+1 kept, -1 broken), which must be involutions (none:
/// all perturbations), and with all kept changes of the period and of the parameters that move, as far as the family
/// does not hold them; the time shift and the family's own direction excluded. In the loop's own coefficients (those
/// under its time map). Empty where the sector holds nothing else. Matrix-free where that is faster. Throws what
/// spectrum::smallest_singular_triplets does.
[[nodiscard]] std::vector<OffBranchTriplet> sector_triplets(const systems::System& system, const loop::Loop& loop,
                                                            const loop::Isotropy& isotropy,
                                                            const std::vector<int>& signs, const loop::Tangent& tangent,
                                                            const spectrum::TripletOptions& options);

/// The smallest eigenvalue of H over all of these perturbations: the paper's off-branch eigenvalue (section III C).
/// With `krylov_from` coefficients or more the whole space is solved at once and matrix-free, which is then faster than
/// sector by sector (docs/performance.md); NaN where that does not converge. It belongs to the coefficients of the loop
/// with s even in time: under a time map the loop and its tangent are expanded so first.
[[nodiscard]] double off_branch_eigenvalue(const systems::System& system, const loop::Loop& loop,
                                           const loop::Isotropy& isotropy, const loop::Tangent& tangent,
                                           int krylov_from = 700);

}  // namespace orbweaver::continuation
