#pragma once

#include <memory>

#include "orbweaver/systems/model/bound.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// What the registry needs of a plugin's model (recorded_model.hpp). Defined in model_system.hpp.
template <class Model>
struct Registered {
  static const ModelInfo& info();
  static std::shared_ptr<const System> make(const Bound& bound);
};

struct RegistryLine {
  const ModelInfo& (*info)();
  std::shared_ptr<const System> (*make)(const Bound& bound);
};

template <class Model>
inline constexpr RegistryLine registry_line{&Registered<Model>::info, &Registered<Model>::make};

}  // namespace orbweaver::systems
