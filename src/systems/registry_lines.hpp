#pragma once

#include <span>
#include <vector>

#include "orbweaver/systems/model/registered.hpp"

namespace orbweaver::systems {

/// All lines of the registry, those of the program first.
[[nodiscard]] const std::vector<RegistryLine>& registry_lines();

/// Throws core::InputError where a name or a meaning cannot be shown as it is: empty, of more than a line, with control
/// characters or bytes that are no UTF-8, or longer than names are.
void require_description(const ModelInfo& info);

/// Adds the lines of a plugin. Throws core::InputError, and adds none, where one is a system or a combination of
/// effects that there is already, or its description is not that of the system of its name.
void add_registry_lines(std::span<const RegistryLine> lines);

}  // namespace orbweaver::systems
