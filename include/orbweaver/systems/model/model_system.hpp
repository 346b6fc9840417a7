#pragma once

#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/model/registered.hpp"
#include "orbweaver/systems/recorded_model.hpp"

namespace orbweaver::systems {

template <class Model>
const ModelInfo& Registered<Model>::info() {
  static const ModelInfo info = Model::info();
  return info;
}

template <class Model>
std::shared_ptr<const System> Registered<Model>::make(const Bound& bound) {
  return recorded<Model>(bound);
}

}  // namespace orbweaver::systems
