#pragma once

#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// The coordinates that move under linear maps z -> p + exp(s A) (z - p), for all s, that keep the field of a
/// Hamiltonian system, p one of `points` (sizes dimension), as under turns about an axis: to each group of them belongs
/// a quantity, an angular momentum, that is conserved and that the structure does not name. Compared at random states
/// near p and farther away to 1e-9. Empty where there are none, where the field is linear, where a parameter moves, for
/// other systems, and for more coordinates than `undeclared_symmetries` looks at.
[[nodiscard]] std::vector<std::string> undeclared_turns(const System& system,
                                                        const std::vector<std::vector<double>>& points);

}  // namespace orbweaver::systems
