#pragma once

#include <span>

#include "orbweaver/loop/isotropy.hpp"
#include "orbweaver/loop/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// The smallest eigenvalue of H over all perturbations of the loop and its period, the time shift and the family's own
/// direction excluded: the paper's off-branch eigenvalue (section III C), in the unscaled coefficients. The Hessian falls
/// apart into the sectors of the isotropy (perturbations that keep or flip the sign under each generator), which are
/// solved one by one; where a generator is not an involution the whole space is taken.
[[nodiscard]] double off_branch_eigenvalue(const systems::System& system, const loop::Loop& loop,
                                           const loop::Isotropy& isotropy, std::span<const double> tangent_modes,
                                           double tangent_period);

}  // namespace orbweaver::continuation
