#pragma once

#include "orbweaver/archive/records.hpp"
#include "orbweaver/loop/isotropy.hpp"
#include "orbweaver/loop/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Fills the row's stability columns from the orbit's Floquet multipliers (spectrum/floquet.hpp); NaN where they cannot
/// be computed (core::NumericalError). `isotropy` is one that the loop has.
void set_stability(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                   archive::OrbitRecord& row);

}  // namespace orbweaver::survey
