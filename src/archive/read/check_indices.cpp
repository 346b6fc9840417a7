#include "check_indices.hpp"

#include <fmt/format.h>

#include "schema/check_records.hpp"

namespace orbweaver::archive {

namespace {

void expect_range(const SerialFile& file, const Table& table, const char* column, std::int64_t lowest,
                  std::size_t count) {
  const auto& values = table.integers(column);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] < lowest || values[i] >= static_cast<std::int64_t>(count))
      file.expect(false, fmt::format("has /{}/{} = {} in row {}, where {} rows can be pointed at", table.name(), column,
                                     values[i], i, count));
}

void expect_ranges(const SerialFile& file, const Table& orbits, const std::string& name, std::uint64_t total) {
  const auto& begins = orbits.integers(name + "_begin");
  const auto& counts = orbits.integers(name + "_count");
  const auto end = static_cast<std::int64_t>(total);
  for (std::size_t i = 0; i < begins.size(); ++i)
    if (begins[i] < 0 || counts[i] < 0 || begins[i] > end || counts[i] > end - begins[i])
      file.expect(false, fmt::format("has /orbits/{}_begin = {} and /orbits/{}_count = {} in row {}, beyond the {} "
                                     "values that are stored",
                                     name, begins[i], name, counts[i], i, total));
}

void expect_mode_counts(const SerialFile& file, const Table& orbits) {
  const auto& cutoffs = orbits.integers("cutoff");
  const auto& counts = orbits.integers("modes_count");
  const auto dimension = static_cast<std::int64_t>(file.header().state_names.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (!is_mode_count(counts[i], cutoffs[i], dimension))
      file.expect(false,
                  fmt::format("has /orbits/modes_count = {} in row {}, where cutoff {} and {} coordinates ask for "
                              "(2 cutoff + 1) x coordinates",
                              counts[i], i, cutoffs[i], dimension));
}

// The families' ranges of orbits follow one another and cover the table, so each orbit has one family.
void expect_family_ranges(const SerialFile& file, const AtlasTables& tables) {
  const auto& firsts = tables.families.integers("first_orbit");
  const auto& counts = tables.families.integers("orbit_count");
  const auto& family = tables.orbits.integers("family");
  const auto rows = static_cast<std::int64_t>(family.size());
  std::int64_t next = 0;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    if (firsts[i] != next || counts[i] < 0 || counts[i] > rows - next)
      file.expect(false,
                  fmt::format("has /families/first_orbit = {} and /families/orbit_count = {} in row {}; the family "
                              "was expected to begin at orbit {} of {}",
                              firsts[i], counts[i], i, next, rows));
    for (const std::int64_t end = next + counts[i]; next < end; ++next)
      if (family[static_cast<std::size_t>(next)] != static_cast<std::int64_t>(i))
        file.expect(false, fmt::format("has /orbits/family = {} in row {}, which lies in the range of family {}",
                                       family[static_cast<std::size_t>(next)], next, i));
  }
  file.expect(next == rows, fmt::format("has {} orbits, of which {} belong to a family's range", rows, next));
}

}  // namespace

void check_indices(const SerialFile& file, const AtlasTables& tables) {
  const std::size_t families = tables.families.rows();
  const std::size_t crossings = tables.crossings.rows();
  expect_range(file, tables.families, "parent", -1, families);
  expect_range(file, tables.families, "crossing", -1, crossings);
  expect_range(file, tables.families, "end_family", -1, families);
  expect_range(file, tables.families, "end_crossing", -1, crossings);
  expect_range(file, tables.crossings, "family", 0, families);
  expect_range(file, tables.orbits, "family", 0, families);
  expect_range(file, tables.sections, "orbit", 0, tables.orbits.rows());
  expect_range(file, tables.loci, "crossing", 0, crossings);
  expect_range(file, tables.loci, "family", 0, families);
  expect_range(file, tables.findings, "family", -1, families);
  expect_range(file, tables.findings, "other_family", -1, families);
  expect_range(file, tables.findings, "crossing", -1, crossings);
  expect_ranges(file, tables.orbits, "modes", tables.mode_values);
  expect_ranges(file, tables.orbits, "time_map", tables.map_values);
  expect_mode_counts(file, tables.orbits);
  expect_family_ranges(file, tables);
}

}  // namespace orbweaver::archive
