#pragma once

#include "orbweaver/systems/model/registered.hpp"

namespace orbweaver::systems {

class PendulumChain;

/// Its dimension is known when its parameters are: SizedSystem adapts it, not ModelSystem.
template <>
struct Registered<PendulumChain> {
  static const ModelInfo& info();
  static const std::vector<std::string>& effects();
  static std::shared_ptr<const System> make(const Bound& bound);
  static std::string type();
};

}  // namespace orbweaver::systems
