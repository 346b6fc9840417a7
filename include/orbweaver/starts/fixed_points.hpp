#pragma once

#include <optional>
#include <span>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The equilibria f(z) = 0 that Newton's method reaches from every point of a grid: `grid[i]` holds the start values of
/// coordinate i (coordinates without a list start at 0). Angles are reduced to [0, 2 pi); each equilibrium appears
/// once, sorted by coordinates. Of a driven system, all coordinates but the phase, which is 0: the points that rest at
/// every phase, as they do while the drive is at zero. Starts that do not converge are dropped, and so are those where
/// the field is not finite, which `not_finite` receives if it is given. Without any list the one start is the origin,
/// and none is found where the field is not finite there. Throws MisuseError for more lists than coordinates,
/// InputError, which names the scene's key, where the field is not finite at any point of the lists.
[[nodiscard]] std::vector<std::vector<double>> find_fixed_points(
    const systems::System& system, const std::vector<std::vector<double>>& grid,
    std::vector<std::vector<double>>* not_finite = nullptr);

/// The equilibrium that Newton's method reaches from `start` (size dimension), angles in [0, 2 pi); none where it
/// reaches none, or one that is farther than `within` from the start.
[[nodiscard]] std::optional<std::vector<double>> fixed_point_near(const systems::System& system,
                                                                  std::span<const double> start, double within);

/// Whether two equilibria that were found are one: rounding apart, relative to 1 + |z|.
[[nodiscard]] bool is_same_fixed_point(std::span<const double> a, std::span<const double> b);

}  // namespace orbweaver::starts
