#include "orbweaver/archive/read/reader.hpp"

#include "check_indices.hpp"
#include "file/serial_file.hpp"

namespace orbweaver::archive {

namespace {

Table read_table(SerialFile& file, TableSpec spec) {
  const std::uint64_t rows = file.expect_table(spec);
  return file.read_table(spec, rows);
}

}  // namespace

Archive::Archive(const std::filesystem::path& path) : _file(std::make_unique<SerialFile>(path, atlas_kind())) {
  const Header& header = _file->header();
  _families = read_table(*_file, families_spec());
  _orbits = read_table(*_file, orbits_spec(header));
  _crossings = read_table(*_file, crossings_spec(header));
  for (const std::string& name : _crossings.texts("kind")) _crossing_kinds.push_back(crossing_kind_of(name));
  _sections = read_table(*_file, sections_spec(header));
  _findings = _file->has_table("findings") ? read_table(*_file, findings_spec()) : Table(findings_spec(), 0);
  _mode_values = _file->expect_flat("modes");
  check_indices(*_file,
                {_families, _orbits, _crossings, _sections, _findings, _mode_values, _file->expect_flat("time_maps")});
}

Archive::Archive(Archive&&) noexcept = default;
Archive& Archive::operator=(Archive&&) noexcept = default;
Archive::~Archive() = default;

const std::filesystem::path& Archive::path() const noexcept { return _file->path(); }

const Header& Archive::header() const noexcept { return _file->header(); }

std::vector<double> Archive::modes(std::size_t orbit) const {
  return values("modes", "modes_begin", "modes_count", orbit);
}

std::vector<double> Archive::time_map(std::size_t orbit) const {
  return values("time_maps", "time_map_begin", "time_map_count", orbit);
}

std::vector<double> Archive::values(const char* dataset, const char* begin, const char* count,
                                    std::size_t orbit) const {
  core::require(orbit < _orbits.rows(), "the archive has no such orbit");
  return _file->read_flat(dataset, static_cast<std::uint64_t>(_orbits.integers(begin)[orbit]),
                          static_cast<std::uint64_t>(_orbits.integers(count)[orbit]));
}

}  // namespace orbweaver::archive
