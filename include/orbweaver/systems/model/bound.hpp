#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "orbweaver/systems/family_scalars.hpp"

namespace orbweaver::systems {

/// What a model is made from: a value for every parameter, and the effects asked for, all checked. Values are numbers,
/// or (to differentiate by a parameter) of the scalar type of the field.
template <class P>
struct BoundTo {
  std::map<std::string, P> parameters;
  std::vector<std::string> effects;
  FamilyScalars scalars{};

  [[nodiscard]] const P& operator[](const std::string& parameter) const { return parameters.at(parameter); }
  [[nodiscard]] bool has(const std::string& effect) const {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  }
};

using Bound = BoundTo<double>;

}  // namespace orbweaver::systems
