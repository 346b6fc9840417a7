#include "page/page_index.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "orbit_stability.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/error.hpp"
#include "stored_system.hpp"

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

std::string verdict_names() {
  std::vector<std::string> names;
  for (int verdict = 0; verdict <= static_cast<int>(last_of(certificate::Verdict{})); ++verdict)
    names.emplace_back(name_of(static_cast<certificate::Verdict>(verdict)));
  return texts(names);
}

}  // namespace

std::string index_members(const archive::Archive& atlas) {
  const archive::Header& header = atlas.header();
  const systems::ModelInfo* info = info_of(header);
  const std::vector<std::pair<const char*, std::string>> members{
      {"orbweaver", json_text(header.orbweaver_version)},
      {"file", json_text(atlas.path().filename().string())},
      {"system", json_text(header.system)},
      {"title", json_text(info == nullptr ? header.system : info->title)},
      {"meaning", json_text(meaning_of(header))},
      {"effects", texts(header.effects)},
      {"parameterNames", texts(header.parameter_names)},
      {"parameterValues", numbers(header.parameter_values)},
      {"parameterUnits", texts(units_of(header))},
      {"moving", json_text(atlas.moving_parameter())},
      {"stateNames", texts(header.state_names)},
      {"angles", wholes(angles_of(atlas))},
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
