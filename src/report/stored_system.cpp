#include "stored_system.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "orbweaver/systems/registry.hpp"

namespace orbweaver::report {

const systems::ModelInfo* info_of(const archive::Header& header) {
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

std::vector<int> angles_of(const archive::Header& header) {
  std::vector<int> angles(header.winding_names.size());
  std::iota(angles.begin(), angles.end(), 0);
  if (info_of(header) == nullptr) return angles;
  std::map<std::string, double> parameters;
  for (std::size_t i = 0; i < header.parameter_names.size(); ++i)
    parameters[header.parameter_names[i]] = header.parameter_values[i];
  const auto system = systems::make_system(header.system, parameters, header.effects);
  return system->structure().angles.size() == angles.size() ? system->structure().angles : angles;
}

}  // namespace orbweaver::report
