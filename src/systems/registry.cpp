#include "orbweaver/systems/registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/plugins.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "pendulum_chain.hpp"
#include "registry_lines.hpp"

namespace orbweaver::systems {

// Models that have effects, which are defined in files of their own.
template <class... Effects>
class DoublePendulum;
template <class... Effects>
class Cr3bp;
template <class... Effects>
class Duffing;
template <class... Effects>
class Pcr3bp;
template <class... Effects>
class SwingingSpring;
template <int coordinates>
class Damping;
template <int coordinates>
class Drive;

// One line a system and combination of its effects, the ideal one first; `class` declares what is defined in a file of
// its own. Each combination is instantiated in the model's source or in combinations/.
constexpr std::array built_in{
    registry_line<Cr3bp<>>,
    registry_line<Cr3bp<class Radiation, class Oblateness>>,
    registry_line<DoublePendulum<>>,
    registry_line<DoublePendulum<class RodInertia>>,
    registry_line<DoublePendulum<class TorsionSprings>>,
    registry_line<DoublePendulum<class JointDamping>>,
    registry_line<DoublePendulum<class PivotDrive>>,
    registry_line<DoublePendulum<class JointTorque>>,
    registry_line<DoublePendulum<JointDamping, PivotDrive>>,
    registry_line<DoublePendulum<JointDamping, JointTorque>>,
    registry_line<DoublePendulum<RodInertia, TorsionSprings, JointDamping, PivotDrive, JointTorque>>,
    registry_line<Duffing<>>,
    registry_line<Duffing<Damping<1>>>,
    registry_line<Duffing<Drive<1>>>,
    registry_line<Duffing<Damping<1>, Drive<1>>>,
    registry_line<class HarmonicOscillator>,
    registry_line<class HenonHeiles>,
    registry_line<class Lorenz>,
    registry_line<Pcr3bp<>>,
    registry_line<Pcr3bp<Radiation>>,
    registry_line<Pcr3bp<Oblateness>>,
    registry_line<Pcr3bp<Radiation, Oblateness>>,
    registry_line<PendulumChain>,
    registry_line<SwingingSpring<>>,
    registry_line<SwingingSpring<Damping<2>>>,
    registry_line<SwingingSpring<Drive<2>>>,
    registry_line<SwingingSpring<Damping<2>, Drive<2>>>,
    registry_line<class ThreeBodies>,
    registry_line<class VanDerPol>,
};

namespace {

std::vector<RegistryLine>& registry() {
  static std::vector<RegistryLine> lines(built_in.begin(), built_in.end());
  return lines;
}

const RegistryLine* find_line(const std::string& name) {
  const auto found = std::find_if(registry().begin(), registry().end(),
                                  [&](const RegistryLine& candidate) { return candidate.info().name == name; });
  return found == registry().end() ? nullptr : &*found;
}

/// One is a combination of effects of the other.
bool are_one_model(const RegistryLine& a, const RegistryLine& b) {
  const auto model = [](const RegistryLine& line) {
    const std::string type = line.type();
    return type.substr(0, type.find('<'));
  };
  return model(a) == model(b) && !a.info().effects.empty();
}

void require_new(const RegistryLine& line) {
  const ModelInfo& info = line.info();
  require_description(info);
  const RegistryLine* known = find_line(info.name);
  if (known == nullptr) return;
  if (!are_one_model(line, *known))
    throw core::InputError(
        fmt::format("it brings a system '{}', and there is another one of that name: rename it", info.name));
  const std::set<std::string> effects(line.effects().begin(), line.effects().end());
  for (const std::vector<std::string>& built : built_effects(info.name))
    if (std::set(built.begin(), built.end()) == effects)
      throw core::InputError(
          fmt::format("it brings '{}' with the effects [{}], which there is already: leave the plugin out", info.name,
                      joined(built)));
}

[[noreturn]] void refuse_combination(const std::string& name, const std::vector<std::string>& effects) {
  std::vector<std::string> texts;
  for (const std::vector<std::string>& built : built_effects(name)) texts.push_back(fmt::format("[{}]", joined(built)));
  throw core::InputError(fmt::format(
      "system '{}' is not compiled with the effects [{}] together; it is with one of {}: choose one of these, or have "
      "it compiled by `orbweaver build-system --model {} --effects {} -o FILE.so` and name that file as the system's "
      "`plugin`",
      name, joined(effects), joined(texts), name, fmt::join(effects, ",")));
}

/// A plugin's model that contradicts itself is wrong input, not a fault of the program.
std::shared_ptr<const System> made(const RegistryLine& line, const Bound& bound) {
  const bool is_built_in =
      std::any_of(built_in.begin(), built_in.end(), [&](const RegistryLine& own) { return own.make == line.make; });
  if (is_built_in) return line.make(bound);
  const std::string& name = line.info().name;
  try {
    return line.make(bound);
  } catch (const core::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw core::InputError(fmt::format("the plugin's system {}: {}", name_with_plugin(name), error.what()));
  }
}

/// What stands between the outer brackets of a template's type.
std::vector<std::string> template_arguments(const std::string& type) {
  std::vector<std::string> arguments;
  std::string argument;
  int depth = 0;
  for (const char c : type) {
    if (c == '>' && --depth == 0 && !argument.empty()) arguments.push_back(argument);
    if (c == ',' && depth == 1) {
      arguments.push_back(argument);
      argument.clear();
    } else if (depth > 0 && (c != ' ' || depth > 1)) {
      argument += c;
    }
    if (c == '<') ++depth;
  }
  return arguments;
}

/// Of the model or of an effect asked for.
bool has_parameter(const ModelInfo& info, const std::vector<std::string>& effects, const std::string& name) {
  const auto holds = [&](const std::vector<Parameter>& parameters) {
    return std::any_of(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
  };
  return holds(info.parameters) || std::any_of(info.effects.begin(), info.effects.end(), [&](const Effect& effect) {
           return std::find(effects.begin(), effects.end(), effect.name) != effects.end() && holds(effect.parameters);
         });
}

/// Numbers named after coordinates are a state.
HeldTotals held_totals(const System& system, std::map<std::string, double> given, const FamilyScalars& moving) {
  HeldTotals held;
  held.moving = moving;
  for (const std::string& coordinate : system.info().state_names)
    if (const auto found = given.find(coordinate); found != given.end()) {
      held.place.push_back(found->second);
      given.erase(found);
    }
  held.values = std::move(given);
  return held;
}

}  // namespace

const std::vector<RegistryLine>& registry_lines() { return registry(); }

void require_description(const ModelInfo& info) {
  constexpr std::size_t longest = 200;
  constexpr std::size_t most_bytes =
      60'000;  // of the 65,535 of an attribute in HDF5's header, the rest for its description
  const auto require = [&](const char* what, const std::string& text, bool may_be_empty = false) {
    if (text.size() > longest || core::printable(text) != text || (text.empty() && !may_be_empty))
      throw core::InputError(fmt::format("its {} `{}`: expected one line of text with 1 to {} characters", what,
                                         core::shortened(core::printable(text), longest), longest));
  };
  const auto require_apart = [&](const char* what, const std::vector<std::string>& names) {
    std::size_t width = sizeof(double);
    for (const std::string& name : names) width = std::max(width, name.size());
    if (names.size() * width > most_bytes)
      throw core::InputError(fmt::format("its {} {} are more than an archive's head holds: expected at most {}",
                                         names.size(), what, most_bytes / width));
    std::set<std::string> known;
    for (const std::string& name : names)
      if (!known.insert(name).second)
        throw core::InputError(fmt::format("two of its {} are named `{}`: expected a name for each", what, name));
  };
  const auto require_parameters = [&](const std::vector<Parameter>& parameters) {
    for (const Parameter& parameter : parameters) {
      require("name of a parameter", parameter.name);
      if (!std::isfinite(parameter.standard))
        throw core::InputError(fmt::format("its parameter `{}` has the standard value {}: expected a finite number",
                                           parameter.name, parameter.standard));
      require("unit of a parameter", parameter.unit, true);
      require("meaning of a parameter", parameter.meaning, true);
    }
  };
  require("name", info.name);
  require("title", info.title, true);
  require("meaning", info.meaning, true);
  for (const std::string& name : info.state_names) require("name of a coordinate", name);
  for (const std::string& name : info.winding_names) require("name of a winding number", name, true);
  require_apart("coordinates", info.state_names);
  require_parameters(info.parameters);
  std::vector<std::string> parameters;
  for (const Parameter& parameter : info.parameters) parameters.push_back(parameter.name);
  require_apart("parameters", parameters);
  for (const Effect& effect : info.effects) {
    require("name of an effect", effect.name);
    require_parameters(effect.parameters);
  }
}

void add_registry_lines(std::span<const RegistryLine> lines) {
  const std::size_t before = registry().size();
  try {
    for (const RegistryLine& line : lines) {
      require_new(line);
      registry().push_back(line);
    }
  } catch (...) {
    registry().resize(before);
    throw;
  }
}

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const RegistryLine& candidate : registry())
    if (std::find(names.begin(), names.end(), candidate.info().name) == names.end())
      names.push_back(candidate.info().name);
  return names;
}

const ModelInfo& model_info(const std::string& name) {
  if (const RegistryLine* line = find_line(name)) return line->info();
  throw core::InputError(fmt::format("there is no system '{}'; the systems are: {}", name, joined(system_names())));
}

std::vector<std::vector<std::string>> built_effects(const std::string& name) {
  const ModelInfo& ideal = model_info(name);
  std::vector<std::vector<std::string>> combinations;
  for (const RegistryLine& candidate : registry())
    if (candidate.info().name == ideal.name) combinations.push_back(candidate.effects());
  return combinations;
}

std::string type_with_effects(const std::string& name, const std::vector<std::string>& effects) {
  const ModelInfo& info = model_info(name);
  if (info.effects.empty()) throw core::InputError(fmt::format("the system {} has no effects", name));
  static_cast<void>(bound_to(info, {}, effects));
  std::map<std::string, std::string> types;
  std::string model;
  for (const RegistryLine& candidate : registry()) {
    if (candidate.info().name != name) continue;
    const std::string type = candidate.type();
    model = type.substr(0, type.find('<'));
    const std::vector<std::string> arguments = template_arguments(type);
    for (std::size_t n = 0; n < arguments.size(); ++n) types[candidate.effects().at(n)] = arguments[n];
  }
  std::vector<std::string> in_order;
  for (const Effect& effect : info.effects)
    if (std::find(effects.begin(), effects.end(), effect.name) != effects.end())
      in_order.push_back(types.at(effect.name));
  return fmt::format("{}<{}>", model, fmt::join(in_order, ", "));
}

std::shared_ptr<const System> make_system(const std::string& name, const std::map<std::string, double>& parameters,
                                          const std::vector<std::string>& effects, const FamilyScalars& scalars) {
  const ModelInfo& info = model_info(name);
  const auto is_own = [&](const std::string& parameter) { return has_parameter(info, effects, parameter); };
  std::map<std::string, double> own;
  std::map<std::string, double> others;  // totals, or a state where they have their values
  for (const auto& [parameter, value] : parameters) (is_own(parameter) ? own : others)[parameter] = value;
  const bool moves_own = std::all_of(scalars.free.begin(), scalars.free.end(), is_own);
  const Bound bound = bound_to(info, own, effects, moves_own ? scalars : FamilyScalars{});
  const std::set<std::string> asked(effects.begin(), effects.end());
  for (const RegistryLine& candidate : registry()) {
    if (candidate.info().name != name) continue;
    const std::vector<std::string>& has = candidate.effects();
    if (std::set(has.begin(), has.end()) != asked) continue;
    std::shared_ptr<const System> system = made(candidate, bound);
    const std::vector<LinearTotal> totals = linear_totals(*system);
    const HeldTotals held = held_totals(*system, others, scalars);
    const auto is_total = [&](const std::string& parameter) {
      return std::any_of(totals.begin(), totals.end(), [&](const auto& total) { return total.name == parameter; });
    };
    const auto is_known = [&](const std::string& parameter) { return is_own(parameter) || is_total(parameter); };
    const bool are_known =
        std::all_of(held.values.begin(), held.values.end(), [&](const auto& of) { return is_known(of.first); }) &&
        std::all_of(scalars.free.begin(), scalars.free.end(), is_known);
    if (!are_known || (totals.empty() && !others.empty()))
      static_cast<void>(bound_to(info, parameters, effects, scalars));  // says which are not
    return totals.empty() ? reduced(std::move(system)) : without_totals(std::move(system), totals, held);
  }
  refuse_combination(name, effects);
}

}  // namespace orbweaver::systems
