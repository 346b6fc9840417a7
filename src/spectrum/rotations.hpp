#pragma once

#include <vector>

#include "floquet_chain.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "transverse_flow.hpp"

namespace orbweaver::spectrum {

/// The product of the flow's factors; empty where rounding hides the smaller multipliers in it.
[[nodiscard]] Eigen::MatrixXd transverse_map(const TransverseFlow& flow);

/// The rotations (Stability::rotations) of a symplectic flow whose fundamental indices and map are known, with the
/// indices' errors. A plane that rounding hides beside the largest multipliers is left out.
[[nodiscard]] std::vector<Rotation> rotations(const systems::System& system, const Chain& chain,
                                              const Stability& known);

}  // namespace orbweaver::spectrum
