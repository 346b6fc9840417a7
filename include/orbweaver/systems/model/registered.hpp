#pragma once

#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/model/bound.hpp"
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
  /// The model's C++ type, "orbweaver::systems::Duffing<orbweaver::systems::Damping<1> >".
  static std::string type();
};

/// A model with one combination of its effects.
struct RegistryLine {
  const ModelInfo& (*info)();
  const std::vector<std::string>& (*effects)();
  std::shared_ptr<const System> (*make)(const Bound& bound);
  std::string (*type)();
};

template <class Model>
inline constexpr RegistryLine registry_line{&Registered<Model>::info, &Registered<Model>::effects,
                                            &Registered<Model>::make, &Registered<Model>::type};

}  // namespace orbweaver::systems
