#include "orbweaver/systems/registry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/document/document.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/plugins.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "orbweaver/systems/text/system_of.hpp"
#include "registry_lines.hpp"
#include "shipped_texts.hpp"

namespace orbweaver::systems {

namespace {

struct TextSystem {
  std::shared_ptr<const ModelText> text;
  ModelInfo info;
};

/// Of the program, by name.
const std::map<std::string, TextSystem>& shipped_systems() {
  static const std::map<std::string, TextSystem> systems = [] {
    std::map<std::string, TextSystem> read;
    for (const auto& [name, text] : shipped_texts()) {
      const document::Source source(fmt::format("{}.yaml", name), {});
      const YAML::Node root = document::parse_document(std::string(text), source.origin(), true);
      const auto model = std::make_shared<const ModelText>(read_model(document::Field(source, root, "", 1)));
      read.emplace(name, TextSystem{model, info_of(*model)});
    }
    return read;
  }();
  return systems;
}

/// Of scenes, by name.
std::map<std::string, TextSystem>& own_systems() {
  static std::map<std::string, TextSystem> systems;
  return systems;
}

const TextSystem* find_text(const std::string& name) {
  for (const std::map<std::string, TextSystem>* systems : {&shipped_systems(), &std::as_const(own_systems())})
    if (const auto found = systems->find(name); found != systems->end()) return &found->second;
  return nullptr;
}

/// Of plugins.
std::vector<RegistryLine>& registry() {
  static std::vector<RegistryLine> lines;
  return lines;
}

const RegistryLine* find_line(const std::string& name) {
  const auto found = std::find_if(registry().begin(), registry().end(),
                                  [&](const RegistryLine& candidate) { return candidate.info().name == name; });
  return found == registry().end() ? nullptr : &*found;
}

void require_new(const RegistryLine& line) {
  const ModelInfo& info = line.info();
  require_description(info);
  if (find_line(info.name) != nullptr || shipped_systems().contains(info.name))
    throw core::InputError(
        fmt::format("it brings a system '{}', and there is another one of that name: rename it", info.name));
}

/// A plugin's model that contradicts itself is wrong input, not a fault of the program.
std::shared_ptr<const System> made(const RegistryLine& line, const Bound& bound) {
  const std::string& name = line.info().name;
  try {
    return line.make(bound);
  } catch (const core::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw core::InputError(fmt::format("the plugin's system {}: {}", name_with_plugin(name), error.what()));
  }
}

void require_sizes(const TextSystem& system, const Bound& bound) {
  for (const ParameterText& size : system.text->terms.parameters) {
    if (!size.is_whole) continue;
    const std::string& name = size.parameter.name;
    if (const double value = bound[name]; value != std::floor(value))
      throw core::InputError(
          fmt::format("parameter '{}' of system '{}' must be a whole number; {} came", name, system.text->name, value));
    if (std::count(bound.scalars.free.begin(), bound.scalars.free.end(), name) > 0)
      throw core::InputError(
          fmt::format("parameter '{}' of system '{}' is a whole number, so that nothing can be "
                      "continued in it; choose another parameter",
                      name, system.text->name));
  }
}

std::shared_ptr<const System> made(const std::string& name, const Bound& bound) {
  if (const RegistryLine* line = find_line(name)) return made(*line, bound);
  const TextSystem& system = *find_text(name);
  require_sizes(system, bound);
  return system_of(build_model(*system.text, bound.parameters, bound.effects), bound);
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
  for (const auto& [name, system] : shipped_systems()) names.push_back(name);
  for (const RegistryLine& candidate : registry()) names.push_back(candidate.info().name);
  return names;
}

const ModelInfo& model_info(const std::string& name) {
  if (const RegistryLine* line = find_line(name)) return line->info();
  if (const TextSystem* system = find_text(name)) return system->info;
  throw core::InputError(fmt::format("there is no system '{}'; the systems are: {}", name, joined(system_names())));
}

void add_model(const std::shared_ptr<const ModelText>& text) {
  if (shipped_systems().contains(text->name) || find_line(text->name) != nullptr)
    throw core::InputError(
        fmt::format("{}: expected a name of its own, got `{}`, which is another system's; give it "
                    "another `name`",
                    text->place, text->name));
  TextSystem& own = own_systems()[text->name];
  if (own.text == text) return;
  TextSystem read{text, info_of(*text)};
  try {
    require_description(read.info);
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}", text->place, error.what()));
  }
  own = std::move(read);
}

std::string system_text(const std::string& name) {
  static_cast<void>(model_info(name));
  for (const auto& [own, text] : shipped_texts())
    if (own == name) return std::string(text);
  return "";
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
  std::shared_ptr<const System> system = made(name, bound);
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

}  // namespace orbweaver::systems
