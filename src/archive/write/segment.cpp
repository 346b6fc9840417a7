#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "file/parallel_file.hpp"
#include "file/segment_file.hpp"
#include "fingerprint.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/pause.hpp"
#include "schema/check_records.hpp"
#include "schema/columns.hpp"
#include "schema/row_checksum.hpp"

namespace orbweaver::archive {

namespace {

// Doubles that a rank stages for one collective write: bounds memory and keeps below MPI's 2 GiB a call.
constexpr std::size_t staged_values = std::size_t{1} << 20;

using VectorMember = std::vector<double> OrbitRecord::*;

std::uint64_t count_values(const Records& mine, VectorMember member) {
  std::uint64_t count = 0;
  for (const OrbitRecord& orbit : mine.orbits) count += (orbit.*member).size();
  return count;
}

void fill_ranges(Table& table, const Records& mine, VectorMember member, const std::string& name, std::uint64_t first) {
  auto& begins = table.integers(name + "_begin");
  auto& counts = table.integers(name + "_count");
  auto& sums = table.integers(name + "_checksum");
  auto next = static_cast<std::int64_t>(first);
  for (std::size_t i = 0; i < mine.orbits.size(); ++i) {
    begins[i] = next;
    counts[i] = static_cast<std::int64_t>((mine.orbits[i].*member).size());
    next += counts[i];
    sums[i] = values_checksum(mine.orbits[i].*member);
  }
}

Table orbit_table(const Header& header, const Records& mine) {
  Table table(segment_orbits_spec(header), mine.orbits.size());
  fill_columns(table, segment_orbit_columns(), [&](std::size_t i) -> const OrbitRecord& { return mine.orbits[i]; });
  return table;
}

Table section_table(const Header& header, const Records& mine) {
  Table table(segment_sections_spec(header), mine.sections.size());
  fill_columns(table, segment_section_columns(),
               [&](std::size_t i) -> const SectionRecord& { return mine.sections[i]; });
  return table;
}

// Walks over the orbits' values as one long row, some at a time.
class Stage {
 public:
  Stage(const Records& mine, VectorMember member) : _mine(mine), _member(member) {}

  std::vector<double> next() {
    std::vector<double> values;
    while (values.size() < staged_values && _orbit < _mine.orbits.size()) {
      const std::vector<double>& source = _mine.orbits[_orbit].*_member;
      const std::size_t count = std::min(source.size() - _at, staged_values - values.size());
      const auto begin = source.begin() + static_cast<std::ptrdiff_t>(_at);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
      _at += count;
      if (_at == source.size()) {
        ++_orbit;
        _at = 0;
      }
    }
    return values;
  }

 private:
  const Records& _mine;
  VectorMember _member;
  std::size_t _orbit = 0;
  std::size_t _at = 0;
};

void write_values(MPI_Comm comm, ParallelFile& file, const std::string& name, const Records& mine, VectorMember member,
                  std::uint64_t first) {
  const std::uint64_t rounds = core::greatest(comm, (count_values(mine, member) + staged_values - 1) / staged_values);
  Stage stage(mine, member);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    std::vector<double> values;
    core::collectively(comm, [&] { values = stage.next(); });
    file.write_flat(name, values, first);
    first += values.size();
  }
}

std::uint64_t fingerprint_of(const Records& mine) {
  Fingerprint fingerprint;
  for (const OrbitRecord& orbit : mine.orbits)
    fingerprint.add(orbit.family_key, orbit.step, orbit.arclength, orbit.period);
  return fingerprint.value();
}

std::vector<std::string> header_texts(const Header& header) {
  std::vector<std::string> texts{header.orbweaver_version, header.scene,
                                 fmt::format("{} {} {}", header.pairs, header.symplectic, header.state_names.size())};
  texts.push_back(fmt::format("{} {} {} {}", header.system, fmt::join(header.winding_coordinates, " "),
                              fmt::join(header.parameter_values, " "), fmt::join(header.scales, " ")));
  texts.insert(texts.end(), header.state_names.begin(), header.state_names.end());
  texts.insert(texts.end(), header.winding_names.begin(), header.winding_names.end());
  return texts;
}

void check_input(MPI_Comm comm, const Header& header, const Records& mine) {
  const std::vector<std::string> own = header_texts(header);
  std::vector<std::string> root = own;
  root = core::agreed(comm, std::move(root));
  core::collectively(comm, [&] {
    core::require(own == root, "the ranks give different headers to write_segment");
    core::require(mine.families.empty() && mine.crossings.empty() && mine.left_out_keys.empty() &&
                      mine.voided.empty() && mine.earlier_scenes.empty(),
                  "segments hold orbits and sections; hand families and crossings to consolidate");
    check_header(header);
    check_orbits(header, mine);
    check_sections(header, mine);
  });
}

}  // namespace

WrittenSegment write_segment(MPI_Comm comm, const std::filesystem::path& path, const Header& header,
                             const Records& mine) {
  const core::LogStage stage(core::Stage::archive);
  check_input(comm, header, mine);
  const core::Share orbit_rows = core::share_of(comm, mine.orbits.size());
  const core::Share section_rows = core::share_of(comm, mine.sections.size());
  const core::Share modes = core::share_of(comm, count_values(mine, &OrbitRecord::modes));
  const core::Share maps = core::share_of(comm, count_values(mine, &OrbitRecord::time_map));
  Table orbits;
  Table sections;
  core::collectively(comm, [&] {
    orbits = orbit_table(header, mine);
    sections = section_table(header, mine);
    fill_ranges(orbits, mine, &OrbitRecord::modes, "modes", modes.first);
    fill_ranges(orbits, mine, &OrbitRecord::time_map, "time_map", maps.first);
    set_checksums(orbits, orbit_rows.first);
    set_checksums(sections, section_rows.first);
  });
  agree_on_text_widths(comm, orbits);
  agree_on_text_widths(comm, sections);

  ParallelFile file(comm, path,
                    {segment_format,
                     header,
                     {{orbits.spec(), orbit_rows.total}, {sections.spec(), section_rows.total}},
                     {{modes_spec(), modes.total}, {time_maps_spec(), maps.total}}});
  file.write_table(orbits, orbit_rows.first);
  file.write_table(sections, section_rows.first);
  core::pause_point("write " + path.filename().string());
  write_values(comm, file, "modes", mine, &OrbitRecord::modes, modes.first);
  write_values(comm, file, "time_maps", mine, &OrbitRecord::time_map, maps.first);
  file.publish();
  std::uint64_t bytes = 0;
  core::collectively(comm, [&] {
    if (core::rank_of(comm) == 0) bytes = std::filesystem::file_size(path);
  });
  return {path.filename().string(), core::greatest(comm, bytes), orbit_rows.total, section_rows.total,
          core::share_of(comm, fingerprint_of(mine)).total};
}

SegmentInfo inspect_segment(const std::filesystem::path& path) {
  const SegmentFile segment(path);
  segment.check_values();
  segment.check_loops();
  return {segment.file().header(), segment.orbits(), segment.sections(), segment.mode_values(), segment.fingerprint()};
}

}  // namespace orbweaver::archive
