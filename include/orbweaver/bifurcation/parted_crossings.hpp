#pragma once

#include <array>
#include <optional>

#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// The index nearest to c = 2 or -2 (q = 1 or 2) less c, by det(P - c/2) = product of -(c/2) (k - c) over all pairs.
/// Where P - c/2 is small in a plane, as where two crossings of the same family lie side by side, it keeps the digits
/// that k - c, which is of the second order in that, has lost. Not a number where `Stability::map` is not known.
[[nodiscard]] Reading determinant_deviation(const systems::Structure& system, const spectrum::Stability& stability,
                                            const Sector& sector);

/// Positions on both sides of a crossing, between which the determinant changes its sign.
struct Parted {
  double from = 0.0;
  double to = 0.0;
};

/// Of a sector with q <= 2, near `place` between two positions of a family: where the index touches the sector's value
/// to rounding, the two crossings at which it passes that and comes back. None where the determinant does not tell that
/// it does.
[[nodiscard]] std::optional<std::array<Parted, 2>> parted_crossings(const systems::System& system,
                                                                    continuation::FamilyCurve& family,
                                                                    const Sector& sector, double place, double from,
                                                                    double to);

}  // namespace orbweaver::bifurcation
