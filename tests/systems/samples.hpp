#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A system with some of its effects, as the registry has it.
struct Built {
  std::string name;
  std::vector<std::string> effects;

  [[nodiscard]] std::shared_ptr<const System> with(const std::map<std::string, double>& parameters = {}) const {
    return make_system(name, parameters, effects);
  }
  /// "double_pendulum", "double_pendulum_with_damping_pivot_drive".
  [[nodiscard]] std::string title() const {
    std::string text = name;
    for (const std::string& effect : effects) text += (text == name ? "_with_" : "_") + effect;
    return text;
  }
};

/// All that is compiled: what is known before a test has loaded a plugin.
inline const std::vector<Built>& all_built() {
  static const std::vector<Built> built = [] {
    std::vector<Built> all;
    for (const std::string& name : system_names())
      for (const std::vector<std::string>& effects : built_effects(name)) all.push_back({name, effects});
    return all;
  }();
  return built;
}
inline const std::vector<Built>& built_before_tests = all_built();

/// A whole number, which can neither be drawn nor differentiated by.
inline bool is_count(const std::string& parameter) { return parameter == "links"; }

/// Every parameter that is no count drawn between half and twice its standard value, those with the standard value 0
/// beside it (all systems so far allow that).
inline std::map<std::string, double> random_parameters(const ModelInfo& info, std::mt19937& generator,
                                                       const std::vector<std::string>& effects = {}) {
  std::uniform_real_distribution<double> factor(0.5, 2.0);
  std::map<std::string, double> parameters;
  const auto draw = [&](const std::vector<Parameter>& list) {
    for (const Parameter& parameter : list)
      if (!is_count(parameter.name))
        parameters[parameter.name] =
            parameter.standard == 0.0 ? factor(generator) - 0.25 : parameter.standard * factor(generator);
  };
  draw(info.parameters);
  for (const Effect& effect : info.effects)
    if (std::count(effects.begin(), effects.end(), effect.name) > 0) draw(effect.parameters);
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
