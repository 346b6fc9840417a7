#include "orbweaver/archive/read/reader.hpp"

#include <algorithm>

#include "check_indices.hpp"
#include "file/serial_file.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "schema/row_checksum.hpp"

namespace orbweaver::archive {

namespace {

Table read_table(SerialFile& file, TableSpec spec) {
  const std::uint64_t rows = file.expect_table(spec);
  return file.read_table(spec, rows);
}

}  // namespace

Archive::Archive(const std::filesystem::path& path, ChangedRows changed)
    : _file(std::make_unique<SerialFile>(core::atlas_named(path), atlas_kind())) {
  const Header& header = _file->header();
  _families = read_table(*_file, families_spec());
  _orbits = read_table(*_file, orbits_spec(header));
  _crossings = read_table(*_file, crossings_spec(header));
  for (const std::string& name : _crossings.texts("kind")) _crossing_kinds.push_back(crossing_kind_of(name));
  _sections = read_table(*_file, sections_spec(header));
  _loci = _file->has_table("loci") ? read_table(*_file, loci_spec(header)) : Table(loci_spec(header), 0);
  _equilibria =
      _file->has_table("equilibria") ? read_table(*_file, equilibria_spec(header)) : Table(equilibria_spec(header), 0);
  _findings = _file->has_table("findings") ? read_table(*_file, findings_spec()) : Table(findings_spec(), 0);
  if (std::string text = _file->read_model(); !text.empty()) _changed.push_back({"model", 0, std::move(text)});
  _mode_values = _file->expect_flat("modes");
  const std::uint64_t map_values = _file->expect_flat("time_maps");
  if (_file->has_checksums()) {
    if (std::string text = _file->change_in_header(); !text.empty()) _changed.push_back({"", 0, std::move(text)});
    for (const Table* table : {&_families, &_orbits, &_crossings, &_sections, &_loci, &_equilibria, &_findings})
      for (const std::size_t row : archive::changed_rows(*table, _file->minor()))
        _changed.push_back({table->name(), row, changed_row(table->name(), row)});
  }
  // An index that was changed is named by itself.
  if (changed == ChangedRows::refused || _changed.empty())
    check_indices(*_file, {_families, _orbits, _crossings, _sections, _loci, _findings, _mode_values, map_values});
  if (changed == ChangedRows::refused && !_changed.empty()) _file->expect(false, _changed.front().text);
}

Archive::Archive(Archive&&) noexcept = default;
Archive& Archive::operator=(Archive&&) noexcept = default;
Archive::~Archive() = default;

const std::filesystem::path& Archive::path() const noexcept { return _file->path(); }

const Header& Archive::header() const noexcept { return _file->header(); }

std::int64_t Archive::format_minor() const noexcept { return _file->minor(); }

bool Archive::has_checksums() const noexcept { return _file->has_checksums(); }

std::string Archive::moving_parameter() const {
  const std::vector<std::string>& scales = header().scale_names;  // it is the last of them
  const std::vector<std::string>& parameters = header().parameter_names;
  if (scales.size() <= 1 + header().state_names.size()) return "";
  return std::find(parameters.begin(), parameters.end(), scales.back()) == parameters.end() ? "" : scales.back();
}

std::vector<double> Archive::modes(std::size_t orbit) const {
  std::vector<double> read = values("modes", "modes", orbit);
  if (!hold(read, "modes", orbit)) _file->expect(false, changed_values("modes", orbit));
  return read;
}

std::vector<double> Archive::time_map(std::size_t orbit) const {
  std::vector<double> read = values("time_maps", "time_map", orbit);
  if (!hold(read, "time_map", orbit)) _file->expect(false, changed_values("time_map", orbit));
  return read;
}

std::vector<ChangedRow> Archive::changed_loop(std::size_t orbit) const {
  std::vector<ChangedRow> changed;
  if (!hold(values("modes", "modes", orbit), "modes", orbit))
    changed.push_back({"orbits", orbit, changed_values("modes", orbit)});
  if (!hold(values("time_maps", "time_map", orbit), "time_map", orbit))
    changed.push_back({"orbits", orbit, changed_values("time_map", orbit)});
  return changed;
}

std::vector<double> Archive::values(const char* dataset, const std::string& name, std::size_t orbit) const {
  core::require(orbit < _orbits.rows(), "the archive has no such orbit");
  return _file->read_flat(dataset, static_cast<std::uint64_t>(_orbits.integers(name + "_begin")[orbit]),
                          static_cast<std::uint64_t>(_orbits.integers(name + "_count")[orbit]));
}

bool Archive::hold(const std::vector<double>& values, const std::string& name, std::size_t orbit) const {
  return !_file->has_checksums() || values_checksum(values) == _orbits.integers(name + "_checksum")[orbit];
}

}  // namespace orbweaver::archive
