#pragma once

#include <cstddef>
#include <span>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// The derivative of the energy by parameter n of those that move, in its scale, by a central difference at the loop's
/// parameters: the sum over states (dimension numbers each) with these weights.
[[nodiscard]] double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n,
                                         std::span<const double> states, std::span<const double> weights);

/// The same at the loop's state at s = 0.
[[nodiscard]] double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n);

}  // namespace orbweaver::continuation
