#include "segment_file.hpp"

#include <fmt/format.h>

#include "schema/check_records.hpp"
#include "schema/row_checksum.hpp"
#include "write/fingerprint.hpp"

namespace orbweaver::archive {

SegmentFile::SegmentFile(const std::filesystem::path& path)
    : _file(path, segment_kind()),
      _orbits(segment_orbits_spec(_file.header())),
      _sections(segment_sections_spec(_file.header())),
      _orbit_rows(_file.expect_table(_orbits)),
      _section_rows(_file.expect_table(_sections)),
      _mode_values(_file.expect_flat("modes")),
      _map_values(_file.expect_flat("time_maps")) {}

void SegmentFile::check_values() const {
  check_ranges("modes_begin", "modes_count", _mode_values);
  check_ranges("time_map_begin", "time_map_count", _map_values);
  const auto cutoffs = orbit_integers("cutoff");
  const auto counts = orbit_integers("modes_count");
  const auto dimension = static_cast<std::int64_t>(_file.header().state_names.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    _file.expect(is_mode_count(counts[i], cutoffs[i], dimension),
                 fmt::format("has {} modes in row {}; cutoff {} asks for another number", counts[i], i, cutoffs[i]));
  const std::string problem = _file.change_in_header();
  _file.expect(problem.empty(), problem);
  check_rows(_orbits, _orbit_rows);
  check_rows(_sections, _section_rows);
}

void SegmentFile::check_rows(const TableSpec& spec, std::uint64_t rows) const {
  if (!_file.has_checksums()) return;
  const std::vector<std::size_t> changed = changed_rows(_file.read_table(spec, rows), _file.minor());
  _file.expect(changed.empty(), changed.empty() ? "" : changed_row(spec.name, changed.front()));
}

void SegmentFile::check_loops() const {
  if (!_file.has_checksums()) return;
  check_loops("modes", "modes");
  check_loops("time_map", "time_maps");
}

void SegmentFile::check_loops(const std::string& name, const std::string& dataset) const {
  const auto begins = orbit_integers((name + "_begin").c_str());
  const auto counts = orbit_integers((name + "_count").c_str());
  const auto sums = orbit_integers((name + "_checksum").c_str());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::vector<double> values =
        _file.read_flat(dataset, static_cast<std::uint64_t>(begins[i]), static_cast<std::uint64_t>(counts[i]));
    _file.expect(values_checksum(values) == sums[i], changed_values(name, i));
  }
}

void SegmentFile::check_ranges(const char* begin, const char* count, std::uint64_t total) const {
  const auto begins = orbit_integers(begin);
  const auto counts = orbit_integers(count);
  const auto end = static_cast<std::int64_t>(total);
  std::int64_t next = 0;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    _file.expect(begins[i] == next && counts[i] >= 0,
                 fmt::format("has {} = {} and {} = {} in row {}; the row was expected to begin at {}", begin, begins[i],
                             count, counts[i], i, next));
    _file.expect(counts[i] <= end - next,
                 fmt::format("stores {} values where its rows of {} add up to more: {} in row {}, and {} before it",
                             total, count, counts[i], i, next));
    next += counts[i];
  }
  _file.expect(next == end, fmt::format("stores {} values where its rows of {} add up to {}", total, count, next));
}

std::uint64_t SegmentFile::fingerprint() const {
  const auto keys = orbit_texts("family_key");
  const auto steps = orbit_integers("step");
  const auto reals = [&](const char* name) {
    return std::get<std::vector<double>>(_file.read("orbits", {name, ColumnType::real, {}}, 0, _orbit_rows).values);
  };
  const auto arclengths = reals("arclength");
  const auto periods = reals("period");
  Fingerprint fingerprint;
  for (std::size_t i = 0; i < keys.size(); ++i) fingerprint.add(keys[i], steps[i], arclengths[i], periods[i]);
  return fingerprint.value();
}

std::vector<std::int64_t> SegmentFile::orbit_integers(const char* name) const {
  return std::get<std::vector<std::int64_t>>(
      _file.read("orbits", {name, ColumnType::integer, {}}, 0, _orbit_rows).values);
}

std::vector<std::string> SegmentFile::orbit_texts(const char* name) const {
  for (const ColumnSpec& spec : _orbits.columns)
    if (spec.name == name) return std::get<std::vector<std::string>>(_file.read("orbits", spec, 0, _orbit_rows).values);
  throw core::MisuseError(fmt::format("segments have no column '{}'", name));
}

}  // namespace orbweaver::archive
