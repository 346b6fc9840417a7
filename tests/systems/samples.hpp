#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/systems/formulas.hpp"
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

/// Effects of a system: none, each alone, any two, all.
inline std::vector<std::vector<std::string>> combinations_of(const std::string& name) {
  std::vector<std::string> all;
  for (const Effect& effect : model_info(name).effects) all.push_back(effect.name);
  std::vector<std::vector<std::string>> combinations{{}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    combinations.push_back({all[i]});
    for (std::size_t j = i + 1; j < all.size(); ++j) combinations.push_back({all[i], all[j]});
  }
  if (all.size() > 2) combinations.push_back(all);
  return combinations;
}

inline const std::vector<Built>& all_built() {
  static const std::vector<Built> built = [] {
    std::vector<Built> all;
    for (const std::string& name : system_names())
      for (const std::vector<std::string>& effects : combinations_of(name)) all.push_back({name, effects});
    return all;
  }();
  return built;
}

/// Nodes of a system's graph at one state, in another arithmetic.
template <class S>
std::vector<S> evaluated(const System& system, const std::vector<S>& state, const std::vector<int> Formulas::*nodes) {
  const Formulas formulas = dynamic_cast<const FormulaSystem&>(system).formulas();
  const std::vector<S> parameters(formulas.values.begin(), formulas.values.end());
  return model::evaluate<S>(formulas.graph, formulas.*nodes, std::span<const S>(state), std::span<const S>(parameters));
}

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
