#pragma once

#include <optional>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/description.hpp"

namespace orbweaver::survey {

/// Fills the row's stability columns; NaN where the multipliers could not be computed.
void set_stability(const systems::Description& system, const std::optional<spectrum::Stability>& stability,
                   archive::OrbitRecord& row);

}  // namespace orbweaver::survey
