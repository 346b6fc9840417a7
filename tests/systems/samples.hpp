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

/// Coordinates in [-2.5, 2.5], where every guard of the system is at least 0.5: differences of a few hundredths stay
/// clear of its singularities.
inline std::vector<double> random_state(const System& system, std::mt19937& generator) {
  constexpr double room = 0.5;
  const auto guards = static_cast<int>(system.structure().guards.size());
  for (;;) {
    std::vector<double> state = random_numbers(static_cast<std::size_t>(system.dimension()), generator);
    bool clear = true;
    for (int k = 0; k < guards; ++k) clear = clear && system.guard(k, state) >= room;
    if (clear) return state;
  }
}

}  // namespace orbweaver::systems
