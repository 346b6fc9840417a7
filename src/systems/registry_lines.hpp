#pragma once

#include <span>
#include <vector>

#include "orbweaver/systems/model/registered.hpp"

namespace orbweaver::systems {

/// Throws core::InputError where a name or a meaning cannot be shown as it is: empty, of more than a line, with control
/// characters or bytes that are no UTF-8, or longer than names are.
void require_description(const ModelInfo& info);

/// Adds the lines of a plugin. Throws core::InputError, and adds none, where there is a system of its name
/// already.
void add_registry_lines(std::span<const RegistryLine> lines);

}  // namespace orbweaver::systems
