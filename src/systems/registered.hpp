#pragma once

#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// What the registry needs of a model. Defined in model_system.hpp and instantiated at the end of the model's own file,
/// so that the registry only has to name the model.
template <class Model>
struct Registered {
  static const Description& describe();
  /// `parameters` holds every parameter, checked.
  static std::shared_ptr<const System> make(const std::map<std::string, double>& parameters);
};

}  // namespace orbweaver::systems
