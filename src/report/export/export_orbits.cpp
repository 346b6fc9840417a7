#include "orbweaver/report/export/export_orbits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "csv_text.hpp"
#include "export/exported_rows.hpp"
#include "json_text.hpp"
#include "orbit_stability.hpp"
#include "table_view.hpp"

namespace orbweaver::report {

namespace {

const std::string& family_name(const archive::Archive& atlas, std::size_t orbit) {
  return atlas.families().texts("name")[static_cast<std::size_t>(atlas.orbits().integers("family")[orbit])];
}

const char* stability_word(const std::optional<bool>& is_stable) {
  if (!is_stable) return "unknown";
  return *is_stable ? "stable" : "unstable";
}

/// The values of an orbit in a column of /orbits.
std::vector<double> values_of(const archive::Archive& atlas, const char* column, std::size_t orbit) {
  const std::size_t width = atlas.orbits().column(column).spec.width();
  const auto begin = atlas.orbits().reals(column).begin() + static_cast<std::ptrdiff_t>(orbit * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

std::vector<std::string> csv_heads(const archive::Archive& atlas) {
  std::vector<std::string> heads{"family", "step", "period", "energy"};
  for (const std::string& name : atlas.header().parameter_names) heads.push_back(csv_text("parameter_" + name));
  heads.emplace_back("linear_stability");
  for (const char* column : {"stability", "state"}) {
    const archive::ColumnSpec& spec = atlas.orbits().column(column).spec;
    for (std::size_t i = 0; i < spec.width(); ++i) heads.push_back(csv_text(value_name(atlas.header(), spec, i)));
  }
  return heads;
}

std::string json_pairs(const std::vector<double>& values) {
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) pairs.push_back(json_list({values[i], values[i + 1]}));
  return fmt::format("[{}]", fmt::join(pairs, ", "));
}

std::string json_parameters(const archive::Archive& atlas, std::size_t orbit) {
  const std::vector<double> values = parameters_at(atlas, orbit);
  std::vector<std::string> members;
  for (std::size_t i = 0; i < values.size(); ++i)
    members.push_back(fmt::format("{}: {}", json_text(atlas.header().parameter_names[i]), json_number(values[i])));
  return fmt::format("{{{}}}", fmt::join(members, ", "));
}

std::string json_orbit(const archive::Archive& atlas, const OrbitStability& stability, std::size_t orbit) {
  const archive::Table& orbits = atlas.orbits();
  const std::vector<double> values = values_of(atlas, "stability", orbit);
  return fmt::format(
      R"({{"family": {}, "step": {}, "period": {}, "energy": {}, "parameters": {}, "linear_stability": "{}", )"
      R"("stability": {}, "state": {}}})",
      json_text(family_name(atlas, orbit)), orbits.integers("step")[orbit], json_number(orbits.reals("period")[orbit]),
      json_number(orbits.reals("energy")[orbit]), json_parameters(atlas, orbit), stability_word(stability.of(orbit)),
      archive::has_complex_stability(atlas.header()) ? json_pairs(values) : json_list(values),
      json_list(values_of(atlas, "state", orbit)));
}

}  // namespace

void export_csv(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection) {
  const std::vector<std::size_t> rows = exported_rows(atlas, selection);
  const OrbitStability stability(atlas);
  out << fmt::format("{}\n", fmt::join(csv_heads(atlas), ","));
  for (const std::size_t orbit : rows) {
    std::vector<std::string> cells{
        csv_text(family_name(atlas, orbit)), std::to_string(atlas.orbits().integers("step")[orbit]),
        csv_number(atlas.orbits().reals("period")[orbit]), csv_number(atlas.orbits().reals("energy")[orbit])};
    for (const double value : parameters_at(atlas, orbit)) cells.push_back(csv_number(value));
    cells.emplace_back(stability_word(stability.of(orbit)));
    for (const char* column : {"stability", "state"})
      for (const double value : values_of(atlas, column, orbit)) cells.push_back(csv_number(value));
    out << fmt::format("{}\n", fmt::join(cells, ","));
  }
}

void export_json(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection) {
  const std::vector<std::size_t> rows = exported_rows(atlas, selection);
  const OrbitStability stability(atlas);
  const archive::Header& header = atlas.header();
  out << fmt::format(
      "{{\"format\": \"orbweaver-orbits\", \"version\": 1, \"orbweaver_version\": {}, \"system\": {}, \"effects\": {}, "
      "\"state_names\": {}, \"stability_values\": \"{}\",\n\"orbits\": [",
      json_text(header.orbweaver_version), json_text(header.system), json_list(header.effects),
      json_list(header.state_names), holds_multipliers(atlas) ? "multipliers" : "indices");
  for (std::size_t n = 0; n < rows.size(); ++n) out << (n == 0 ? "\n" : ",\n") << json_orbit(atlas, stability, rows[n]);
  out << "\n]}\n";
}

}  // namespace orbweaver::report
