#include "numbering.hpp"
#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "file/segment_file.hpp"

namespace orbweaver::archive {

namespace {

class SegmentScan {
 public:
  SegmentScan(const std::vector<std::string>& segments, const Header& header, const Selection& selection)
      : _segments(segments), _header(header), _selection(selection) {}

  void read(std::size_t index) {
    const SegmentFile segment(_segments[index]);
    segment.check_values();
    expect_same_header(segment);
    read_orbits(segment, static_cast<std::int64_t>(index));
    read_sections(segment, static_cast<std::int64_t>(index));
  }

  std::vector<OrbitRow> orbits;
  std::vector<SectionRow> sections;

 private:
  void expect_same_header(const SegmentFile& segment) const {
    const Header& found = segment.file().header();
    const bool same_columns = found.state_names == _header.state_names &&
                              found.winding_names == _header.winding_names && found.pairs == _header.pairs &&
                              found.scales == _header.scales &&
                              has_complex_stability(found) == has_complex_stability(_header);
    segment.file().expect(same_columns,
                          "was written for another system (state names, angles, stability or scales differ)");
    const auto& earlier = _selection.earlier_scenes;
    segment.file().expect(
        found.scene == _header.scene || std::find(earlier.begin(), earlier.end(), found.scene) != earlier.end(),
        "was written for another scene");
  }

  [[nodiscard]] bool is_voided(std::int64_t segment, const std::string& key, std::int64_t step) const {
    const auto& keys = _selection.voided_keys;
    const auto [first, last] = std::equal_range(keys.begin(), keys.end(), key);
    const auto at = [&](auto position) { return _selection.voided.begin() + (position - keys.begin()); };
    return std::any_of(at(first), at(last), [&](const VoidedSteps& rows) {
      return segment < rows.before_segment && step >= rows.steps.first && step <= rows.steps.last;
    });
  }

  // Nothing for a row that is left out.
  [[nodiscard]] std::optional<std::int64_t> family_of(const SegmentFile& segment, std::int64_t index,
                                                      const std::string& key, std::int64_t step) const {
    if (is_voided(index, key, step)) return std::nullopt;
    if (std::binary_search(_selection.left_out.begin(), _selection.left_out.end(), key)) return std::nullopt;
    const auto& keys = _selection.keys;
    const auto found = std::lower_bound(keys.begin(), keys.end(), key);
    segment.file().expect(found != keys.end() && *found == key,
                          fmt::format("has rows of family '{}', which is not among the families handed over", key));
    const std::int64_t family = found - keys.begin();
    const StepRange& steps = _selection.steps[static_cast<std::size_t>(family)];
    if (step < steps.first || step > steps.last) return std::nullopt;
    return family;
  }

  void read_orbits(const SegmentFile& segment, std::int64_t index) {
    const auto keys = segment.orbit_texts("family_key");
    const auto steps = segment.orbit_integers("step");
    const auto modes_begin = segment.orbit_integers("modes_begin");
    const auto modes_count = segment.orbit_integers("modes_count");
    const auto map_begin = segment.orbit_integers("time_map_begin");
    const auto map_count = segment.orbit_integers("time_map_count");
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (const auto family = family_of(segment, index, keys[i], steps[i]))
        orbits.push_back({*family, steps[i], index, static_cast<std::int64_t>(i), modes_begin[i], modes_count[i],
                          map_begin[i], map_count[i]});
  }

  void read_sections(const SegmentFile& segment, std::int64_t index) {
    const Table table = segment.file().read_table(segment.sections_spec(), segment.sections());
    const auto& keys = table.texts("family_key");
    const auto& steps = table.integers("step");
    const auto& times = table.reals("time");
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (const auto family = family_of(segment, index, keys[i], steps[i]))
        sections.push_back({*family, steps[i], index, static_cast<std::int64_t>(i), -1, times[i]});
  }

  const std::vector<std::string>& _segments;
  const Header& _header;
  const Selection& _selection;
};

template <class Row>
std::tuple<std::int64_t, std::int64_t> place(const Row& row) {
  return {row.family, row.step};
}

void sort_orbits(std::vector<OrbitRow>& orbits, const std::vector<std::string>& segments,
                 const std::vector<std::string>& keys) {
  std::sort(orbits.begin(), orbits.end(), [](const auto& a, const auto& b) {
    return std::tuple(place(a), a.segment, a.row) < std::tuple(place(b), b.segment, b.row);
  });
  const auto twice = std::adjacent_find(orbits.begin(), orbits.end(),
                                        [](const auto& a, const auto& b) { return place(a) == place(b); });
  if (twice == orbits.end()) return;
  const auto name = [&](const OrbitRow& row) { return segments[static_cast<std::size_t>(row.segment)]; };
  throw core::InputError(fmt::format(
      "orbit {} of family '{}' stands twice in the segments: row {} of '{}' and row {} of '{}'. Leave out the segment "
      "that the last checkpoint does not list.",
      twice->step, keys[static_cast<std::size_t>(twice->family)], twice->row, name(*twice), (twice + 1)->row,
      name(*(twice + 1))));
}

void sort_sections(std::vector<SectionRow>& sections, const std::vector<OrbitRow>& orbits,
                   const std::vector<std::string>& segments, const std::vector<std::string>& keys) {
  for (SectionRow& section : sections) {
    const auto found = std::lower_bound(orbits.begin(), orbits.end(), section,
                                        [](const auto& a, const auto& b) { return place(a) < place(b); });
    if (found == orbits.end() || place(*found) != place(section))
      throw core::InputError(
          fmt::format("'{}' has a section point of orbit {} of family '{}', which no segment holds. "
                      "Give all segments that the last checkpoint lists.",
                      segments[static_cast<std::size_t>(section.segment)], section.step,
                      keys[static_cast<std::size_t>(section.family)]));
    section.orbit = found - orbits.begin();
  }
  std::sort(sections.begin(), sections.end(), [](const auto& a, const auto& b) {
    return std::tie(a.orbit, a.time, a.segment, a.row) < std::tie(b.orbit, b.time, b.segment, b.row);
  });
}

std::vector<std::uint64_t> running_sum(const std::vector<OrbitRow>& orbits, std::int64_t OrbitRow::*count) {
  std::vector<std::uint64_t> sums{0};
  sums.reserve(orbits.size() + 1);
  for (const OrbitRow& row : orbits) sums.push_back(sums.back() + static_cast<std::uint64_t>(row.*count));
  return sums;
}

}  // namespace

std::int64_t Numbering::first_orbit(std::int64_t family) const {
  const auto found = std::lower_bound(orbits.begin(), orbits.end(), family,
                                      [](const OrbitRow& row, std::int64_t index) { return row.family < index; });
  return found - orbits.begin();
}

Numbering number_rows(MPI_Comm comm, const std::vector<std::string>& segments, const Header& header,
                      const Selection& selection) {
  SegmentScan scan(segments, header, selection);
  core::collectively(comm, [&] {
    const auto stride = static_cast<std::size_t>(core::size_of(comm));
    for (auto i = static_cast<std::size_t>(core::rank_of(comm)); i < segments.size(); i += stride) scan.read(i);
  });
  Numbering numbering;
  numbering.orbits = core::gather_rows(comm, scan.orbits);
  numbering.sections = core::gather_rows(comm, scan.sections);
  core::collectively(comm, [&] {
    sort_orbits(numbering.orbits, segments, selection.keys);
    sort_sections(numbering.sections, numbering.orbits, segments, selection.keys);
    numbering.modes_at = running_sum(numbering.orbits, &OrbitRow::modes_count);
    numbering.maps_at = running_sum(numbering.orbits, &OrbitRow::map_count);
  });
  return numbering;
}

}  // namespace orbweaver::archive
