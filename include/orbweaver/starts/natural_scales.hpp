#pragma once

#include <vector>

#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The scales in which times, coordinates and conserved quantities of a system are of order 1, powers of two, from its
/// equilibria (find_fixed_points from `grid`; docs/mathematics.md, "Scales"): with other units of the parameters they
/// change as the units do. A driven system stands for its mean over the phases of the drive; where that rests nowhere,
/// the grid's points for its equilibria. All 1 where another system has no equilibrium there, or nothing says how large
/// its motions are (a linear system without angles, nor a drive). Throws what find_fixed_points does.
[[nodiscard]] systems::Scales natural_scales(const systems::System& system,
                                             const std::vector<std::vector<double>>& grid);

}  // namespace orbweaver::starts
