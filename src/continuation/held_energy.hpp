#pragma once

#include <cstddef>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// The derivative of the energy at a loop's state by parameter n of those that move, in its scale, by a central
/// difference.
[[nodiscard]] double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n);

}  // namespace orbweaver::continuation
