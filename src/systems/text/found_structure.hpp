#pragma once

#include <map>
#include <string>
#include <vector>

#include "orbweaver/systems/family_scalars.hpp"
#include "orbweaver/systems/structure.hpp"
#include "orbweaver/systems/text/built_model.hpp"

namespace orbweaver::systems {

/// What holds for a model with these values, in the order of its parameters: symmetries and conserved quantities for
/// them and for all values of `free` ones, friction for all values of effects' parameters too. `conserved` gets the
/// nodes of the structure's quantities. Adds nodes to the graph. Throws core::InputError where the text claims what
/// does not hold.
[[nodiscard]] Structure found_structure(BuiltModel& model, const std::vector<double>& values,
                                        const std::vector<std::string>& free, std::vector<int>& conserved);

}  // namespace orbweaver::systems
