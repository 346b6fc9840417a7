#include "system_section.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::scene {

namespace {

void read_effects(const Field& field, SystemChoice& choice) {
  std::vector<std::string> known;
  for (const systems::Effect& effect : info_of(choice).effects) known.push_back(effect.name);
  for (const Field& item : field.list("[]")) {
    if (known.empty())
      item.fail(fmt::format("no effects, for the system {} has none", choice.name), item.got(), "remove it");
    const std::string effect = item.choice(known);
    if (std::count(choice.effects.begin(), choice.effects.end(), effect) > 0)
      item.fail("each effect once", item.got() + " again", "remove one");
    choice.effects.push_back(effect);
  }
  ask_system(field, choice);
}

bool holds(const std::vector<systems::Parameter>& parameters, const std::string& name) {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const systems::Parameter& parameter) { return parameter.name == name; });
}

/// Says which effect brings a parameter of the map `field` that is not known, since the scene does not ask for it.
void refuse_without_effect(const Field& field, const systems::ModelInfo& info,
                           const std::vector<systems::Parameter>& known, std::string_view example) {
  for (const Field::Entry& entry : field.entries(example))
    for (const systems::Effect& effect : info.effects)
      if (const std::string name = entry.key.key(); holds(effect.parameters, name) && !holds(known, name))
        entry.value.fail("a parameter of the system or of an effect asked for",
                         fmt::format("one of the effect `{}`, which is not", effect.name),
                         fmt::format("add `effects: [{}]`, or remove it", effect.name));
}

bool is_asked_for(const SystemChoice& choice, const systems::Effect& effect) {
  return std::count(choice.effects.begin(), choice.effects.end(), effect.name) > 0;
}

}  // namespace

void ask_system(const Field& field, const SystemChoice& choice) {
  try {
    static_cast<void>(bound_system(choice));
  } catch (const core::InputError& error) {
    field.fail(error.what());
  }
}

std::shared_ptr<const systems::System> bound_system(const SystemChoice& choice) {
  if (choice.model) systems::add_model(choice.model);
  return systems::make_system(choice.name, choice.parameters, choice.effects, choice.moving);
}

const systems::ModelInfo& info_of(const SystemChoice& choice) {
  if (choice.model) systems::add_model(choice.model);
  return systems::model_info(choice.name);
}

std::vector<systems::Parameter> known_parameters(const systems::ModelInfo& info, const SystemChoice& choice) {
  std::vector<systems::Parameter> known = info.parameters;
  for (const systems::Effect& effect : info.effects)
    if (is_asked_for(choice, effect))
      for (const systems::Parameter& parameter : effect.parameters)
        if (!holds(known, parameter.name)) known.push_back(parameter);
  if (choice.name != info.name) return known;
  const std::shared_ptr<const systems::System> system = bound_system(choice);
  for (const systems::Parameter& parameter : system->info().parameters)  // totals
    if (!holds(known, parameter.name)) known.push_back(parameter);
  return known;
}

void read_parameters(const Field& field, const systems::ModelInfo& info, SystemChoice& choice) {
  const std::vector<systems::Parameter> known = known_parameters(info, choice);
  constexpr std::string_view example = "parameters: {m1: 1}";
  refuse_without_effect(field, info, known, example);
  std::vector<std::string> names;
  for (const systems::Parameter& parameter : known) names.push_back(parameter.name);
  const Keys keys(field, names, example);
  for (const systems::Parameter& parameter : known) {
    const auto value = keys.find(parameter.name);
    if (!value) continue;
    const std::string standard = fmt::format("{}", parameter.standard);
    choice.parameters[parameter.name] = value->number(
        {.lower = parameter.lower, .upper = parameter.upper, .lower_open = parameter.lower_open, .example = standard});
    ask_system(*value, choice);
  }
}

namespace {

// One number each, > 0, for time, coordinates that are no angles, and conserved quantities.
void read_scales(const Field& field, SystemChoice& choice) {
  if (field.plain_scalar() == "auto") return;
  const auto system = bound_system(choice);
  const systems::Structure& structure = system->structure();
  const std::vector<std::string>& coordinates = system->info().state_names;
  const std::vector<std::string> names = scale_names(*system);
  const Keys keys(field, names, "scales: auto");
  for (const std::string& name : names) {
    const auto value = keys.find(name);
    if (!value || value->plain_scalar() == "auto") continue;
    const double scale = value->number({.lower = 0, .lower_open = true, .example = "1"});
    const auto i =
        static_cast<std::size_t>(std::find(coordinates.begin(), coordinates.end(), name) - coordinates.begin());
    if (i < coordinates.size() && structure.is_angle(i) && scale != 1.0)
      value->fail("1, the scale of every angle", value->got(), "remove it");
    choice.scales[name] = scale;
  }
  const std::vector<std::size_t> first = systems::mixed_coordinates(structure);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto one = choice.scales.find(coordinates[i]);
    const auto other = choice.scales.find(coordinates[first[i]]);
    const auto none = choice.scales.end();
    if ((one == none) == (other == none) && (one == none || one->second == other->second)) continue;
    field.fail(fmt::format("one scale for {} and {}, which a symmetry mixes", coordinates[first[i]], coordinates[i]),
               field.got(), "give both the same, or none");
  }
}

}  // namespace

std::vector<std::string> scale_names(const systems::System& system) {
  std::vector<std::string> names{"time"};
  for (const std::vector<std::string>* more :
       {&system.info().state_names, &system.structure().conserved, &system.family_scalars().free})
    names.insert(names.end(), more->begin(), more->end());
  return names;
}

namespace {

/// The text of a model's file beside the scene.
std::string text_of_file(const Field& file, const std::filesystem::path& path) {
  if (const std::string got = core::unreadable_input(path); !got.empty())
    file.fail("the file of a model, told from the scene's folder", got, "check the path");
  std::ifstream stream(path, std::ios::binary);
  std::string text(longest_scene + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

bool has_equations(const Field& field) {
  if (!field.is_map()) return false;
  for (const Field::Entry& entry : field.entries("system: {name: double_pendulum}"))
    for (const char* form : {"equations", "hamiltonian", "lagrangian"})
      if (entry.key.key() == form) return true;
  return false;
}

/// Known for this version: until the one before systems came from shared libraries too, of which archives hold no
/// formulas.
void refuse_plugin(const Field& field, bool is_stored) {
  if (!field.is_map()) return;
  for (const Field::Entry& entry : field.entries("system: {name: double_pendulum}"))
    if (const std::string key = entry.key.key(); key == "plugin" || key == "plugin_source" || key == "plugin_abi")
      entry.value.fail(is_stored ? "the system's formulas" : "equations, or a file that has them as `model_file`",
                       is_stored ? "none, for it was made with a plugin" : entry.value.got() + ", of a plugin",
                       is_stored ? "survey the system again with equations in `system:` (docs/models.md)"
                                 : "write them here; `orbweaver systems lorenz --text` shows some (docs/models.md)");
}

}  // namespace

void read_system(const Field& field, const std::optional<std::filesystem::path>& folder, SystemChoice& system,
                 std::string& model) {
  refuse_plugin(field, !folder);
  const bool is_stored = !model.empty();
  const bool is_inline = has_equations(field);
  std::vector<std::string> known = names_of_keys(field.path());
  known.insert(known.end(), {"model_file", "active"});  // docs/models.md
  if (is_inline) known.insert(known.end(), systems::model_keys().begin(), systems::model_keys().end());
  const Keys keys(field, known, "system: {name: double_pendulum}");
  const auto name = keys.find("name");
  const auto file = keys.find("model_file");
  if (is_inline && file) field.fail("equations, or a file that has them", "both", "remove one");
  if (!name && !is_inline && !file)
    field.fail("the system's `name`, or its `equations`", "a map without them",
               "add for example `name: double_pendulum`");
  if (is_inline) {
    system.model =
        std::make_shared<const systems::ModelText>(systems::read_model(field, {"active", "scales", "model_file"}));
  } else if (file) {
    const std::filesystem::path path = folder.value_or("") / file->text("my_model.yaml", longest_path);
    if (folder) model = text_of_file(*file, path);
    if (!folder && !is_stored)
      file->fail("the model's text, stored beside the scene", "none", "write its equations here");
    system.model = systems::read_model_text(model, quoted(path.string()));
  } else if (const auto shipped = systems::shipped_model(name->scalar().value_or(""));
             is_stored && (!shipped || systems::system_text(shipped->name) != model)) {
    system.model = systems::read_model_text(model, "the model of the archive");  // of another version
  } else {
    system.name = name->choice(systems::system_names());
    system.model = shipped;
    model = systems::system_text(system.name);
  }
  if (system.model) system.name = system.model->name;
  if (system.model && name && name->text("my_model") != system.name)
    name->fail(fmt::format("the model's name, `{}`", system.name), name->got(), "leave it out");
  if ((is_inline || file) && !is_stored && systems::shipped_model(system.name))
    throw core::InputError(
        fmt::format("{}: expected a name of its own, got `{}`, which is another system's; give it another `name`",
                    system.model->place, system.name));
  if (const auto active = keys.find("active"); active && !is_inline)
    active->fail("effects by the key `effects`, as the equations do not stand in the scene", "`active`", "rename it");
  if (const auto effects = keys.find(is_inline ? "active" : "effects")) read_effects(*effects, system);
  if (is_inline)
    ask_system(field, system);
  else if (const auto parameters = keys.find("parameters"))
    read_parameters(*parameters, info_of(system), system);
  if (const auto scales = keys.find("scales")) read_scales(*scales, system);
}

}  // namespace orbweaver::scene
