#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// The smallest value over the whole loop of guard number `guard` of the system's structure, in the guard's unit: the
/// minima among nodes in s, refined on the loop itself by Brent's method, so that a smooth one is right to rounding.
/// NaN where the guard is. Throws MisuseError for a guard that the structure does not name.
[[nodiscard]] double least_guard(const systems::System& system, int guard, const loop::Loop& loop);

/// Guard number `guard` at each sample of a loop.
[[nodiscard]] std::vector<double> guard_at(const systems::System& system, int guard, const loop::Samples& samples);

}  // namespace orbweaver::continuation
