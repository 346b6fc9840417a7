#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fields.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::scene {

/// Fills `system`, effects before parameters; throws core::InputError as Field does. `folder`: of the scene's file,
/// none for a stored scene. `model`: the text stored with it, empty where there is none; then the text of the model,
/// empty where it stands in the scene or a program has recorded it.
void read_system(const Field& field, const std::optional<std::filesystem::path>& folder, SystemChoice& system,
                 std::string& model);

/// Fails at `field`, with what the layer `systems` says, where it refuses to bind the system as chosen.
void ask_system(const Field& field, const SystemChoice& choice);

/// What has a scale: time, coordinates, conserved quantities.
[[nodiscard]] std::vector<std::string> scale_names(const systems::System& system);

/// Fills `choice.parameters` from the map of parameters of the model chosen; throws core::InputError as Field does, for
/// a parameter of an effect that is not chosen too.
void read_parameters(const Field& field, const systems::ModelInfo& info, SystemChoice& choice);

/// The parameters that the model has with the effects chosen.
[[nodiscard]] std::vector<systems::Parameter> known_parameters(const systems::ModelInfo& info,
                                                               const SystemChoice& choice);

}  // namespace orbweaver::scene
