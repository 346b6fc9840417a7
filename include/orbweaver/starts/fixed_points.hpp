#pragma once

#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The equilibria f(z) = 0 that Newton's method reaches from every point of a grid: `grid[i]` holds the start values of
/// coordinate i (coordinates without a list start at 0). Angles are reduced to [0, 2 pi); each equilibrium appears
/// once, sorted by coordinates. Starts that do not converge are dropped. Throws MisuseError for more lists than
/// coordinates, NotFiniteError where the field is not finite at a start.
[[nodiscard]] std::vector<std::vector<double>> find_fixed_points(const systems::System& system,
                                                                 const std::vector<std::vector<double>>& grid);

}  // namespace orbweaver::starts
