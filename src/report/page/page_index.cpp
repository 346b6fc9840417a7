#include "page/page_index.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "orbit_stability.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::report {

namespace {

template <class Values, class Text>
std::string list(const Values& values, Text text) {
  std::vector<std::string> texts;
  for (const auto& value : values) texts.push_back(text(value));
  return fmt::format("[{}]", fmt::join(texts, ","));
}

std::string texts(const std::vector<std::string>& values) { return list(values, json_text); }
std::string numbers(const std::vector<double>& values) { return list(values, json_number); }
std::string wholes(const std::vector<int>& values) { return fmt::format("[{}]", fmt::join(values, ",")); }

/// {"name": [...], ...}: all columns but checksums, each flat.
std::string table(const archive::Table& rows) {
  std::vector<std::string> columns;
  for (const archive::Column& column : rows.columns()) {
    if (archive::is_checksum(column.spec)) continue;
    std::string values;
    if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&column.values))
      values = fmt::format("[{}]", fmt::join(*whole, ","));
    else if (const auto* reals = std::get_if<std::vector<double>>(&column.values))
      values = numbers(*reals);
    else
      values = texts(std::get<std::vector<std::string>>(column.values));
    columns.push_back(fmt::format("{}:{}", json_text(column.spec.name), values));
  }
  return fmt::format("{{{}}}", fmt::join(columns, ","));
}

const systems::ModelInfo* info_of(const archive::Header& header) {
  const std::vector<std::string> known = systems::system_names();
  return std::find(known.begin(), known.end(), header.system) == known.end() ? nullptr
                                                                             : &systems::model_info(header.system);
}

std::vector<std::string> units_of(const archive::Header& header) {
  std::vector<std::string> units(header.parameter_names.size());
  const systems::ModelInfo* info = info_of(header);
  if (info == nullptr) return units;
  for (std::size_t i = 0; i < units.size(); ++i)
    for (const systems::Parameter& parameter : info->parameters)
      if (parameter.name == header.parameter_names[i]) units[i] = parameter.unit;
  return units;
}

std::string verdict_names() {
  std::vector<std::string> names;
  for (int verdict = 0; verdict <= static_cast<int>(last_of(certificate::Verdict{})); ++verdict)
    names.emplace_back(name_of(static_cast<certificate::Verdict>(verdict)));
  return texts(names);
}

}  // namespace

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

std::string index_members(const archive::Archive& atlas) {
  const archive::Header& header = atlas.header();
  const systems::ModelInfo* info = info_of(header);
  const std::vector<std::pair<const char*, std::string>> members{
      {"orbweaver", json_text(header.orbweaver_version)},
      {"file", json_text(atlas.path().filename().string())},
      {"system", json_text(header.system)},
      {"title", json_text(info == nullptr ? header.system : info->title)},
      {"effects", texts(header.effects)},
      {"parameterNames", texts(header.parameter_names)},
      {"parameterValues", numbers(header.parameter_values)},
      {"parameterUnits", texts(units_of(header))},
      {"stateNames", texts(header.state_names)},
      {"angles", wholes(angles_of(header))},
      {"pairs", fmt::format("{}", header.pairs)},
      {"multipliers", holds_multipliers(atlas) ? "true" : "false"},
      {"complex", archive::has_complex_stability(header) ? "true" : "false"},
      {"verdicts", verdict_names()},
      {"scene", json_text(header.scene)},
      {"families", table(atlas.families())},
      {"crossings", table(atlas.crossings())},
      {"findings", table(atlas.findings())},
  };
  std::vector<std::string> texts_of_members;
  for (const auto& [name, value] : members) texts_of_members.push_back(fmt::format("\"{}\":{}", name, value));
  return fmt::format("{}", fmt::join(texts_of_members, ","));
}

}  // namespace orbweaver::report
