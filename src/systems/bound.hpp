#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace orbweaver::systems {

/// What a model is made from: a value for every parameter, and the effects asked for, all checked.
struct Bound {
  std::map<std::string, double> parameters;
  std::vector<std::string> effects;

  [[nodiscard]] double operator[](const std::string& parameter) const { return parameters.at(parameter); }
  [[nodiscard]] bool has(const std::string& effect) const {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  }
};

}  // namespace orbweaver::systems
