#pragma once

#include <filesystem>
#include <optional>

#include <yaml-cpp/yaml.h>

#include "orbweaver/scene/scene.hpp"
#include "fields.hpp"

namespace orbweaver::scene {

/// Of a system that is handed out with fewer coordinates: where the grid's first point, the first state or the
/// trajectory's has all of them, they go into the choice's parameters, as the state at which linear totals have the
/// values that are held (systems::HeldTotals). What is not right is left to the readers of the starts.
void take_place(const Field& starts, SystemChoice& choice);

/// `starts:`. Files are told from `folder`; none: those of a stored scene, which are not read.
void read_starts(const Field& field, const systems::System& system, const std::optional<std::filesystem::path>& folder,
                 Scene& scene);

/// Writes the hash of each file that is a start beside it; true where the text had them all.
[[nodiscard]] bool keep_hashes(const Scene& scene, YAML::Node& root);

}  // namespace orbweaver::scene
