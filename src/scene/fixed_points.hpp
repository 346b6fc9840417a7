#pragma once

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "fields.hpp"

namespace orbweaver::scene {

/// Fills `points`, angles in radians, and leaves the defaults of absent keys alone; throws core::InputError as Field
/// does.
void read_fixed_points(const Field& field, const systems::System& system, FixedPoints& points);

}  // namespace orbweaver::scene
