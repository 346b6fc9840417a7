#include "check_records.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::archive {

namespace {

// Texts become fixed-length columns as wide as their longest row, so one runaway text would swell a whole column.
constexpr std::size_t longest_text = 4096;
// HDF5 keeps attributes in an object header, which ends at 64 KiB.
constexpr std::size_t longest_scene = 60000;

[[noreturn]] void refuse(const std::string& record, const std::string& problem) {
  throw core::MisuseError(fmt::format("cannot archive {}: {}", record, problem));
}

void expect(bool condition, const std::string& record, const std::string& problem) {
  if (!condition) refuse(record, problem);
}

void check_text(const std::string& record, const char* member, const std::string& text,
                std::size_t longest = longest_text) {
  expect(text.size() <= longest, record,
         fmt::format("{} has {} bytes; at most {} are stored", member, text.size(), longest));
  expect(text.find('\0') == std::string::npos, record, fmt::format("{} contains a zero byte", member));
  expect(core::first_untextual(text) == std::string::npos, record, fmt::format("{} is not valid UTF-8", member));
}

void check_key(const std::string& record, const std::string& key) {
  expect(!key.empty(), record, "its family key is empty");
  check_text(record, "the family key", key);
}

// The text is made only when it is needed: modes are many.
void check_finite(const std::string& record, const char* member, double value) {
  if (!std::isfinite(value)) refuse(record, fmt::format("{} is {}; a finite number was expected", member, value));
}

void check_size(const std::string& record, const char* member, std::size_t size, std::size_t expected,
                const std::string& because) {
  if (size != expected)
    refuse(record, fmt::format("{} holds {} values; {} were expected ({})", member, size, expected, because));
}

void check_vector(const std::string& record, const char* member, const std::vector<double>& values,
                  std::size_t expected, const std::string& because) {
  check_size(record, member, values.size(), expected, because);
  for (const double value : values) check_finite(record, member, value);
}

void check_optional(const std::string& record, const char* member, const std::vector<double>& values,
                    std::size_t expected, const std::string& because) {
  if (!values.empty()) check_size(record, member, values.size(), expected, because + ", or none");
}

void check_orbit(const Header& header, const OrbitRecord& orbit) {
  const std::string record = fmt::format("orbit {} of family '{}'", orbit.step, orbit.family_key);
  const std::size_t dimension = header.state_names.size();
  check_key(record, orbit.family_key);
  check_finite(record, "arclength", orbit.arclength);
  check_finite(record, "period", orbit.period);
  expect(orbit.cutoff >= 0, record, fmt::format("cutoff is {}; 0 or more was expected", orbit.cutoff));
  check_optional(record, "stability", orbit.stability, stability_width(header), "stability_width");
  check_optional(record, "fundamental_stability", orbit.fundamental_stability, stability_width(header),
                 "stability_width");
  check_vector(record, "state", orbit.state, dimension, "one a state name");
  check_vector(record, "modes", orbit.modes, (2 * static_cast<std::size_t>(orbit.cutoff) + 1) * dimension,
               fmt::format("(2 x {} + 1) x {}", orbit.cutoff, dimension));
  for (const double value : orbit.time_map) check_finite(record, "time_map", value);
  check_optional(record, "winding", orbit.winding, header.winding_names.size(), "one a winding name");
}

void check_index(const std::string& record, const char* member, int index, std::size_t count) {
  expect(index >= -1 && index < static_cast<std::int64_t>(count), record,
         fmt::format("{} is {}; -1 or an index below {} was expected", member, index, count));
}

void check_reference(const std::string& record, const char* member, const std::string& key,
                     const std::set<std::string>& keys) {
  expect(key.empty() || keys.count(key) == 1, record,
         fmt::format("{} '{}' is not the key of a family of this archive", member, key));
}

}  // namespace

void check_header(const Header& header) {
  const std::string record = "a header";
  expect(!header.state_names.empty(), record, "it names no state coordinate");
  expect(header.pairs >= 0, record, fmt::format("pairs is {}; 0 or more was expected", header.pairs));
  check_text(record, "orbweaver_version", header.orbweaver_version);
  if (header.scene.size() > longest_scene)
    throw core::InputError(fmt::format("the scene has {} bytes; an archive holds at most {}. Shorten its comments.",
                                       header.scene.size(), longest_scene));
  check_text(record, "the scene", header.scene, longest_scene);
  check_text(record, "the model", header.model, longest_model);
  for (const std::string& name : header.state_names) check_text(record, "a state name", name);
  for (const std::string& name : header.winding_names) check_text(record, "a winding name", name);
  if (const std::string problem = winding_problem(header); !problem.empty()) expect(false, record, problem);
}

std::string winding_problem(const Header& header) {
  const std::vector<int>& wind = header.winding_coordinates;
  const std::set<int> all(wind.begin(), wind.end());
  const std::size_t names = header.winding_names.size();
  const bool fits =
      wind.size() == names && all.size() == names &&
      (names == 0 || (*all.begin() >= 0 && *all.rbegin() < static_cast<std::int64_t>(header.state_names.size())));
  return fits ? ""
              : fmt::format(
                    "has winding_coordinates [{}]; another of 0 to {} for each of the {} winding names was "
                    "expected",
                    fmt::join(wind, ", "), header.state_names.size() - 1, names);
}

void check_orbits(const Header& header, const Records& records) {
  for (const OrbitRecord& orbit : records.orbits) check_orbit(header, orbit);
}

void check_sections(const Header& header, const Records& records) {
  for (const SectionRecord& section : records.sections) {
    const std::string record =
        fmt::format("a section point of orbit {} of family '{}'", section.step, section.family_key);
    check_key(record, section.family_key);
    check_finite(record, "time", section.time);
    check_vector(record, "state", section.state, header.state_names.size(), "one a state name");
  }
}

void check_families(const Records& records) {
  std::set<std::string> keys;
  for (const FamilyRecord& family : records.families) {
    const std::string record = fmt::format("family '{}'", family.key);
    check_key(record, family.key);
    expect(keys.insert(family.key).second, record, "another family has the same key");
    expect(std::count(records.left_out_keys.begin(), records.left_out_keys.end(), family.key) == 0, record,
           "its key is among those left out too");
    expect(family.first_step <= family.last_step, record,
           fmt::format("its steps end at {} before they begin at {}", family.last_step, family.first_step));
    check_text(record, "name", family.name);
    check_text(record, "isotropy", family.isotropy);
    check_text(record, "end_reason", family.end_reason);
    expect(!family.end_reason.empty(), record, "it has no end_reason; a finished archive says why each family ended");
    check_index(record, "crossing", family.crossing, records.crossings.size());
    check_index(record, "end_crossing", family.end_crossing, records.crossings.size());
  }
  for (const FamilyRecord& family : records.families) {
    const std::string record = fmt::format("family '{}'", family.key);
    check_reference(record, "parent_key", family.parent_key, keys);
    check_reference(record, "end_family_key", family.end_family_key, keys);
  }
}

void check_crossings(const Header& header, const Records& records) {
  std::set<std::string> keys;
  for (const FamilyRecord& family : records.families) keys.insert(family.key);
  for (const CrossingRecord& crossing : records.crossings) {
    const std::string record =
        fmt::format("the crossing at arclength {} of family '{}'", crossing.arclength, crossing.family_key);
    check_key(record, crossing.family_key);
    check_reference(record, "family_key", crossing.family_key, keys);
    check_finite(record, "arclength", crossing.arclength);
    check_finite(record, "period", crossing.period);
    expect(crossing.kind != CrossingKind::unknown, record,
           "its kind is unknown; one of those that have names was expected");
    check_vector(record, "state", crossing.state, header.state_names.size(), "one a state name");
  }
}

void check_loci(const Header& header, const Records& records) {
  std::set<std::string> keys;
  for (const FamilyRecord& family : records.families) keys.insert(family.key);
  for (const LocusRecord& point : records.loci) {
    const std::string record =
        fmt::format("point {} of locus {} of family '{}'", point.step, point.locus, point.family_key);
    check_key(record, point.family_key);
    check_reference(record, "family_key", point.family_key, keys);
    expect(point.crossing >= 0, record, "it begins at no crossing");
    check_index(record, "crossing", point.crossing, records.crossings.size());
    check_finite(record, "arclength", point.arclength);
    check_finite(record, "period", point.period);
    check_text(record, "second_name", point.second_name);
    check_text(record, "note", point.note);
    expect(point.kind != CrossingKind::unknown, record,
           "its kind is unknown; one of those that have names was expected");
    check_vector(record, "state", point.state, header.state_names.size(), "one a state name");
  }
}

void check_equilibria(const Header& header, const Records& records) {
  const std::size_t dimension = header.state_names.size();
  std::set<std::pair<int, int>> places;
  for (const EquilibriumRecord& point : records.equilibria) {
    const std::string record = fmt::format("point {} of equilibrium {}", point.step, point.equilibrium);
    expect(point.equilibrium >= 0, record, "its number is negative");
    expect(places.emplace(point.equilibrium, point.step).second, record, "there is another one");
    check_finite(record, "arclength", point.arclength);
    check_vector(record, "state", point.state, dimension, "one a state name");
    check_optional(record, "eigenvalues", point.eigenvalues, 2 * dimension, "two a state name");
    check_optional(record, "periods", point.periods, dimension / 2, "one a pair of state names");
    check_size(record, "multiplicity", point.multiplicity.size(), point.periods.size(), "one a period");
    for (const std::string* text : {&point.kind, &point.stability, &point.note}) check_text(record, "a text", *text);
  }
}

void check_voided(const Records& records, std::size_t segments) {
  for (const VoidedRows& rows : records.voided) {
    const std::string record = fmt::format("voided rows of family '{}'", rows.family_key);
    check_key(record, rows.family_key);
    expect(rows.first_step <= rows.last_step, record,
           fmt::format("their steps end at {} before they begin at {}", rows.last_step, rows.first_step));
    expect(rows.before_segment >= 0 && rows.before_segment <= static_cast<std::int64_t>(segments), record,
           fmt::format("before_segment is {}; 0 ... {} was expected", rows.before_segment, segments));
  }
}

bool is_mode_count(std::int64_t count, std::int64_t cutoff, std::int64_t dimension) {
  // A cutoff above the count cannot be right, and could not be doubled.
  return cutoff >= 0 && cutoff <= count && count % dimension == 0 && count / dimension == 2 * cutoff + 1;
}

}  // namespace orbweaver::archive
