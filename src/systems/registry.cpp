#include "orbweaver/systems/registry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/document/document.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "orbweaver/systems/text/system_of.hpp"
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
      const auto model = read_model_text(std::string(text), fmt::format("{}.yaml", name));
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
  for (const std::map<std::string, TextSystem>* systems : {&std::as_const(own_systems()), &shipped_systems()})
    if (const auto found = systems->find(name); found != systems->end()) return &found->second;
  return nullptr;
}

struct RecordedSystem {
  ModelInfo info;
  SystemMaker make;
};

/// Of a program that links the library, by name.
std::map<std::string, RecordedSystem>& recorded_systems() {
  static std::map<std::string, RecordedSystem> systems;
  return systems;
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
  if (const auto found = recorded_systems().find(name); found != recorded_systems().end())
    return found->second.make(bound);
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

void add_recorded(ModelInfo info, SystemMaker make) {
  require_description(info);
  const std::string name = info.name;
  if (shipped_systems().contains(name))
    throw core::InputError(fmt::format("there is a system of the program named '{}': rename this one", name));
  recorded_systems().insert_or_assign(name, RecordedSystem{std::move(info), make});
}

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const auto& [name, system] : shipped_systems()) names.push_back(name);
  for (const auto& [name, system] : recorded_systems()) names.push_back(name);
  return names;
}

const ModelInfo& model_info(const std::string& name) {
  if (const auto found = recorded_systems().find(name); found != recorded_systems().end()) return found->second.info;
  if (const TextSystem* system = find_text(name)) return system->info;
  throw core::InputError(fmt::format("there is no system '{}'; the systems are: {}", name, joined(system_names())));
}

std::shared_ptr<const ModelText> shipped_model(const std::string& name) {
  const auto found = shipped_systems().find(name);
  return found == shipped_systems().end() ? nullptr : found->second.text;
}

std::shared_ptr<const ModelText> read_model_text(const std::string& text, const std::string& place) {
  const document::Source source(place, {});
  const YAML::Node root = document::parse_document(text, place, true);
  const document::Field whole(source, root, "", 1);
  if (!root.IsMap()) whole.fail("a model, a map", whole.got(), "for example `equations: {x': y, y': -x}`");
  return std::make_shared<const ModelText>(read_model(whole));
}

void add_model(const std::shared_ptr<const ModelText>& text) {
  if (recorded_systems().contains(text->name))
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
