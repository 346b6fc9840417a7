#pragma once

#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/system.hpp"
#include "reader.hpp"

namespace orbweaver::scene {

/// Fills `system`, effects before parameters; throws core::InputError as Field does.
void read_system(const Field& field, SystemChoice& system);

/// What has a scale: time, coordinates, conserved quantities.
[[nodiscard]] std::vector<std::string> scale_names(const systems::System& system);

/// The parameters that the system has with the effects chosen.
[[nodiscard]] std::vector<systems::Parameter> known_parameters(const SystemChoice& choice);

}  // namespace orbweaver::scene
