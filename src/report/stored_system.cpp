#include "stored_system.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::report {

namespace {

/// As the survey had it, reduced by its conserved quantities; null where this program does not know it.
std::shared_ptr<const systems::System> system_of(const archive::Header& header) {
  if (info_of(header) == nullptr) return nullptr;
  std::map<std::string, double> parameters;
  for (std::size_t i = 0; i < header.parameter_names.size(); ++i)
    parameters[header.parameter_names[i]] = header.parameter_values[i];
  const auto system = systems::make_system(header.system, parameters, header.effects);
  const std::vector<std::string>& all = info_of(header)->state_names;
  const bool has_some = std::all_of(header.state_names.begin(), header.state_names.end(), [&](const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  });
  if (system->info().state_names == header.state_names || !has_some) return system;
  // Which coordinates follow from totals: those that the rows do not have.
  for (const std::string& name : all)
    parameters.insert({name, std::count(header.state_names.begin(), header.state_names.end(), name) == 0 ? 1.0 : 0.0});
  return systems::make_system(header.system, parameters, header.effects);
}

}  // namespace

bool has_energies(const archive::Archive& atlas) {
  const std::vector<double>& energies = atlas.orbits().reals("energy");
  return std::any_of(energies.begin(), energies.end(), [](double energy) { return !std::isnan(energy); });
}

const systems::ModelInfo* info_of(const archive::Header& header) {
  try {
    if (!header.model.empty()) systems::add_model(systems::read_model_text(header.model, "/model"));
  } catch (const core::InputError&) {  // of a later version
    return nullptr;
  }
  const std::vector<std::string> known = systems::system_names();
  return std::find(known.begin(), known.end(), header.system) == known.end() ? nullptr
                                                                             : &systems::model_info(header.system);
}

std::vector<std::string> units_of(const archive::Header& header) {
  std::vector<std::string> units(header.parameter_names.size());
  const systems::ModelInfo* info = info_of(header);
  if (info == nullptr) return units;
  std::vector<systems::Parameter> parameters = info->parameters;
  for (const systems::Effect& effect : info->effects)
    parameters.insert(parameters.end(), effect.parameters.begin(), effect.parameters.end());
  for (std::size_t i = 0; i < units.size(); ++i)
    for (const systems::Parameter& parameter : parameters)
      if (parameter.name == header.parameter_names[i]) units[i] = parameter.unit;
  return units;
}

std::string meaning_of(const archive::Header& header) {
  const auto system = system_of(header);
  return system == nullptr ? "" : system->info().meaning;
}

std::optional<std::vector<int>> known_angles_of(const archive::Header& header) {
  const std::vector<int>& said = header.winding_coordinates;
  if (said.size() == header.winding_names.size()) return said;
  const auto system = system_of(header);
  if (system == nullptr || system->structure().angles.size() != header.winding_names.size()) return std::nullopt;
  return system->structure().angles;
}

std::vector<int> angles_of(const archive::Archive& atlas) {
  std::optional<std::vector<int>> angles = known_angles_of(atlas.header());
  if (!angles)
    throw core::InputError(fmt::format(
        "{} does not say which coordinates wind (it is of format_minor {}, before 11), and the formulas of its "
        "system {} are missing",
        atlas.path().string(), atlas.format_minor(), atlas.header().system));
  return *std::move(angles);
}

}  // namespace orbweaver::report
