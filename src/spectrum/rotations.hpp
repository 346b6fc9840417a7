#pragma once

#include <vector>

#include "floquet_chain.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "transverse_flow.hpp"

namespace orbweaver::spectrum {

/// The rotations (Stability::rotations) of a symplectic flow whose fundamental indices are known with their errors. A
/// plane that rounding hides beside the largest multipliers is left out.
[[nodiscard]] std::vector<Rotation> rotations(const systems::System& system, const Chain& chain,
                                              const TransverseFlow& flow, const Stability& known);

}  // namespace orbweaver::spectrum
