#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bound.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// What the registry needs of a model. Defined in model_system.hpp and instantiated at the end of the model's own file,
/// so that the registry only has to name the model.
template <class Model>
struct Registered {
  static const ModelInfo& info();
  /// Names of the effects that it has.
  static const std::vector<std::string>& effects();
  static std::shared_ptr<const System> make(const Bound& bound);
};

}  // namespace orbweaver::systems
