#include "system_section.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::scene {

std::vector<systems::Parameter> known_parameters(const SystemChoice& choice) {
  const systems::ModelInfo& info = systems::model_info(choice.name);
  std::vector<systems::Parameter> known = info.parameters;
  for (const systems::Effect& effect : info.effects)
    if (std::count(choice.effects.begin(), choice.effects.end(), effect.name) > 0)
      known.insert(known.end(), effect.parameters.begin(), effect.parameters.end());
  return known;
}

namespace {

// The layer `systems` knows what is allowed; the scene knows where it was asked for.
void ask_system(const Field& field, const SystemChoice& choice) {
  try {
    static_cast<void>(systems::make_system(choice.name, choice.parameters, choice.effects));
  } catch (const core::InputError& error) {
    field.fail(error.what());
  }
}

void read_effects(const Field& field, SystemChoice& choice) {
  std::vector<std::string> known;
  for (const systems::Effect& effect : systems::model_info(choice.name).effects) known.push_back(effect.name);
  for (const Field& item : field.list("[]")) {
    if (known.empty())
      item.fail(fmt::format("no effects, for the system {} has none", choice.name), item.got(), "remove it");
    choice.effects.push_back(item.choice(known));
    ask_system(item, choice);
  }
}

void read_parameters(const Field& field, SystemChoice& choice) {
  const std::vector<systems::Parameter> known = known_parameters(choice);
  std::vector<std::string> names;
  for (const systems::Parameter& parameter : known) names.push_back(parameter.name);
  const Keys keys(field, names, "parameters: {m1: 1}");
  for (const systems::Parameter& parameter : known) {
    const auto value = keys.find(parameter.name);
    if (!value) continue;
    const std::string example = fmt::format("{}", parameter.standard);
    choice.parameters[parameter.name] = value->number(
        {.lower = parameter.lower, .upper = parameter.upper, .lower_open = parameter.lower_open, .example = example});
    ask_system(*value, choice);
  }
}

}  // namespace

void read_system(const Field& field, SystemChoice& system) {
  const Keys keys(field, {"name", "parameters", "effects"}, "system: {name: double_pendulum}");
  const auto name = keys.find("name");
  if (!name) field.fail("the system's `name`", "a map without it", "add for example `name: double_pendulum`");
  system.name = name->choice(systems::system_names());
  if (const auto effects = keys.find("effects")) read_effects(*effects, system);
  if (const auto parameters = keys.find("parameters")) read_parameters(*parameters, system);
}

}  // namespace orbweaver::scene
