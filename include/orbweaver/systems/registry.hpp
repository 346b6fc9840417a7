#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/model/bound.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/system.hpp"
#include "orbweaver/systems/text/model_text.hpp"

namespace orbweaver::systems {

using SystemMaker = std::shared_ptr<const System> (*)(const Bound& bound);
/// Adds a model that a program has in C++ (systems/recorded_model.hpp); a later one of that name takes its place.
/// Throws core::InputError where a name or a meaning cannot be shown, or a system of the program has its name.
void add_recorded(ModelInfo info, SystemMaker make);

/// Names of all systems: the program's, and those added.
[[nodiscard]] std::vector<std::string> system_names();

/// What may be asked of the system `name`. Throws core::InputError naming the known ones.
[[nodiscard]] const ModelInfo& model_info(const std::string& name);

/// The text of a system of the program (docs/models.md); "" of a recorded one. Throws core::InputError as model_info.
[[nodiscard]] std::string system_text(const std::string& name);

/// The model of a system of the program; null for another name.
[[nodiscard]] std::shared_ptr<const ModelText> shipped_model(const std::string& name);

/// Reads a model, the text of a file or of an archive; `place` stands before what is wrong with it.
[[nodiscard]] std::shared_ptr<const ModelText> read_model_text(const std::string& text, const std::string& place);

/// Makes the model the system of its name; a later one of that name takes its place. Throws core::InputError with the
/// text's place where a program has recorded a model of that name, or its names cannot be shown.
void add_model(const std::shared_ptr<const ModelText>& text);

/// Binds parameters and effects, in any order of the effects. Throws core::InputError on an unknown system, parameter
/// or effect, an effect named twice, or a value out of range, saying what is
/// known or allowed; the same for the parameters that move along families.
[[nodiscard]] std::shared_ptr<const System> make_system(const std::string& name,
                                                        const std::map<std::string, double>& parameters = {},
                                                        const std::vector<std::string>& effects = {},
                                                        const FamilyScalars& scalars = {});

}  // namespace orbweaver::systems
