#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// Names of all registered systems.
[[nodiscard]] std::vector<std::string> system_names();

/// What may be asked of the system `name`. Throws core::InputError naming the known ones.
[[nodiscard]] const ModelInfo& model_info(const std::string& name);

/// The combinations of its effects that the system `name` is compiled with, the empty one first.
[[nodiscard]] std::vector<std::vector<std::string>> built_effects(const std::string& name);

/// The C++ type of the system `name` with effects, "orbweaver::systems::Duffing<orbweaver::systems::Damping<1>>", also
/// where it is not compiled with them together. Throws core::InputError on an unknown system or effect, one named
/// twice, or a system that has none.
[[nodiscard]] std::string type_with_effects(const std::string& name, const std::vector<std::string>& effects);

/// Binds parameters and effects, in any order of the effects. Throws core::InputError on an unknown system, parameter
/// or effect, an effect named twice, effects that are not compiled together, or a value out of range, saying what is
/// known or allowed; the same for the parameters that move along families.
[[nodiscard]] std::shared_ptr<const System> make_system(const std::string& name,
                                                        const std::map<std::string, double>& parameters = {},
                                                        const std::vector<std::string>& effects = {},
                                                        const FamilyScalars& scalars = {});

}  // namespace orbweaver::systems
