#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::survey {

/// From a state to the nearest one of an orbit, to rounding; angles modulo 2 pi. Same coordinates as the loop's.
[[nodiscard]] double distance_to_orbit(const systems::Structure& system, const loop::Loop& loop,
                                       const std::vector<double>& state);

}  // namespace orbweaver::survey
