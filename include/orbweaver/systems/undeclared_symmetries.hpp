#pragma once

#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// Symmetries z -> p + S (z - p) + h of the field that the structure of `system` does not declare and that no product
/// of declared ones is, S a change of the signs of some coordinates, p one of `points` (sizes dimension) and h zero or
/// half a turn of one angle, as of a drive's phase: each as text, "the reversor (x, y, px, py) -> (x, y, -px, -py)".
/// Reversors first, those with the fewest signs; of what these generate nothing more. The field's derivatives by the
/// parameters that move must have them too. Compared at random states near p and farther away to 1e-10 of the field's
/// size there. Empty for systems of more than `most_sign_changes` coordinates, of which there are too many.
[[nodiscard]] std::vector<std::string> undeclared_symmetries(const System& system,
                                                             const std::vector<std::vector<double>>& points);

/// The coordinates that move along translations which keep the field of a Hamiltonian system: to each translation
/// belongs a momentum that is conserved and that the structure does not name. Empty where there are none, and for other
/// systems.
[[nodiscard]] std::vector<std::string> undeclared_translations(const System& system);

inline constexpr int most_sign_changes = 10;

}  // namespace orbweaver::systems
