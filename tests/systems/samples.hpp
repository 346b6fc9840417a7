#pragma once

#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// Every parameter drawn between half and twice its standard value (all systems so far allow that).
inline std::map<std::string, double> random_parameters(const ModelInfo& info, std::mt19937& generator) {
  std::uniform_real_distribution<double> factor(0.5, 2.0);
  std::map<std::string, double> parameters;
  for (const Parameter& parameter : info.parameters)
    parameters[parameter.name] = parameter.standard * factor(generator);
  return parameters;
}

inline std::vector<double> random_numbers(std::size_t count, std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-2.5, 2.5);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = uniform(generator);
  return numbers;
}

}  // namespace orbweaver::systems
