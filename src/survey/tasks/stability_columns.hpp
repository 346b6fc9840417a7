#pragma once

#include <optional>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::survey {

/// Fills the row's stability columns; NaN where the multipliers could not be computed.
void set_stability(const systems::Structure& system, const std::optional<spectrum::Stability>& stability,
                   archive::OrbitRecord& row);

}  // namespace orbweaver::survey
