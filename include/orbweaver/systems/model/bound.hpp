#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "orbweaver/systems/family_scalars.hpp"

namespace orbweaver::systems {

/// Throws StructureError: a model asks for a parameter that its info does not name.
[[noreturn]] void refuse_parameter(const std::string& asked, const std::vector<std::string>& known);

/// What a model is made from: a value for every parameter, and the effects asked for, all checked. Values are numbers,
/// or (to differentiate by a parameter) of the scalar type of the field.
template <class P>
struct BoundTo {
  std::map<std::string, P> parameters;
  std::vector<std::string> effects;
  FamilyScalars scalars{};

  /// Throws StructureError for one that there is not.
  [[nodiscard]] const P& operator[](const std::string& parameter) const {
    if (const auto found = parameters.find(parameter); found != parameters.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [name, value] : parameters) known.push_back(name);
    refuse_parameter(parameter, known);
  }
  [[nodiscard]] bool has(const std::string& effect) const {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  }
};

using Bound = BoundTo<double>;

}  // namespace orbweaver::systems
