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

/// Fills `choice.parameters` from the map of parameters of the model chosen; throws core::InputError as Field does, for
/// a parameter of an effect that is not chosen too.
void read_parameters(const Field& field, const systems::ModelInfo& info, SystemChoice& choice);

/// The parameters that the model has with the effects chosen.
[[nodiscard]] std::vector<systems::Parameter> known_parameters(const systems::ModelInfo& info,
                                                               const SystemChoice& choice);

}  // namespace orbweaver::scene
