#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// The logarithm of the factor by which volumes of the space of states change over a period: the integral of div f
/// (Liouville's formula), which is the logarithm of the product of all multipliers. In two dimensions it is that of the
/// only nontrivial one, also where that is beyond double precision's range. By the trapezoidal rule on the loss's grid,
/// so as accurate as the loop. Throws as loss::Linearization.
[[nodiscard]] double log_volume(const systems::System& system, const loop::Loop& loop);

}  // namespace orbweaver::spectrum
