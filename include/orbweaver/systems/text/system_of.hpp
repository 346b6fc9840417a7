#pragma once

#include <memory>

#include "orbweaver/systems/model/bound.hpp"
#include "orbweaver/systems/system.hpp"
#include "orbweaver/systems/text/built_model.hpp"

namespace orbweaver::systems {

/// The system of a model with values for all its parameters; what holds for it is found at states drawn by chance, with
/// the error of rounding at hand. Throws core::InputError with the place of what does not hold though the text says so.
[[nodiscard]] std::shared_ptr<const System> system_of(BuiltModel model, const Bound& bound);

/// The same where a program says what holds; the structure's conserved quantities are the model's first ones. Throws
/// StructureError where it does not fit the model.
[[nodiscard]] std::shared_ptr<const System> system_of(BuiltModel model, Structure structure, const Bound& bound);

}  // namespace orbweaver::systems
