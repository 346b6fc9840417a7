#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::bifurcation {

/// The stability of an orbit of a family with its position.
struct StabilityAt {
  double position = 0.0;
  spectrum::Stability stability;
};

/// That of the orbit at a position between known ones; nothing if there is none to be had.
using StabilityBetween = std::function<std::optional<spectrum::Stability>(double position)>;

/// Orbits between two at which more pairs of multipliers are off the unit circle than at both, one where two pairs meet
/// on it, leave it, and have come back to it before the second orbit: two Krein collisions that its test function does
/// not show. Ascending. Such pairs are told by their planes (spectrum::Rotation): their angles have changed order.
[[nodiscard]] std::vector<StabilityAt> meetings_between(const StabilityAt& from, const StabilityAt& to,
                                                        const StabilityBetween& between);

}  // namespace orbweaver::bifurcation
