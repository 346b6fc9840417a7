#include "show_stability.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbit_stability.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t most_intervals = 8;
/// Changes of T that six digits show, relative to it.
constexpr double shown_change = 1e-6;

/// What tells orbits of a family from one another: T, or the parameter that moves where T is one number, as under a
/// drive.
struct Told {
  std::string name;
  const char* column;
  archive::CrossingKind fold;
};

// Its value at which stability changes between neighbouring orbits: of the crossing that was located there, or that of
// the stable one.
double boundary(const archive::Archive& atlas, const Told& by, std::size_t family, std::size_t stable,
                std::size_t unstable) {
  const auto& arclengths = atlas.orbits().reals("arclength");
  const auto [from, to] = std::minmax(arclengths[stable], arclengths[unstable]);
  const archive::Table& crossings = atlas.crossings();
  for (std::size_t row = 0; row < crossings.rows(); ++row) {
    const archive::CrossingKind kind = atlas.crossing_kinds()[row];
    const double where = crossings.reals("arclength")[row];
    const bool is_between =
        where >= from && where <= to && crossings.integers("family")[row] == static_cast<std::int64_t>(family);
    if (is_between && kind != archive::CrossingKind::subharmonic && kind != archive::CrossingKind::fold_period)
      return crossings.reals(by.column)[row];
  }
  return atlas.orbits().reals(by.column)[stable];
}

/// The turns that an interval names, at most; with more of them it is said how many there are.
constexpr std::size_t most_turns = 3;

/// The value at which T, or the parameter, turns at or next to an orbit: that of the fold located there, if any.
double turn_near(const archive::Archive& atlas, const Told& by, std::size_t family, std::size_t orbit) {
  const auto& arclengths = atlas.orbits().reals("arclength");
  const archive::Table& crossings = atlas.crossings();
  for (std::size_t row = 0; row < crossings.rows(); ++row) {
    const double where = crossings.reals("arclength")[row];
    if (atlas.crossing_kinds()[row] == by.fold &&
        crossings.integers("family")[row] == static_cast<std::int64_t>(family) && where >= arclengths[orbit - 1] &&
        where <= arclengths[orbit + 1])
      return crossings.reals(by.column)[row];
  }
  return atlas.orbits().reals(by.column)[orbit];
}

/// How a value goes along the orbits of a family.
struct Course {
  bool rises = false;
  bool falls = false;
};

Course course_of(const std::vector<double>& values, std::size_t first, std::size_t end) {
  double least = values[first];
  double most = values[first];
  Course course;
  for (std::size_t orbit = first; orbit < end; ++orbit) {
    const double visible = shown_change * std::abs(values[orbit]);
    course.rises = course.rises || values[orbit] > least + visible;
    course.falls = course.falls || values[orbit] < most - visible;
    least = std::min(least, values[orbit]);
    most = std::max(most, values[orbit]);
  }
  return course;
}

Told told_by(const archive::Archive& atlas, std::size_t first, std::size_t end) {
  const Course course = course_of(atlas.orbits().reals("period"), first, end);
  if (const std::string moving = atlas.moving_parameter(); !moving.empty() && !course.rises && !course.falls)
    return {moving, "parameter", archive::CrossingKind::fold_parameter};
  return {"T", "period", archive::CrossingKind::fold_period};
}

/// "8.44 .. 9.1"; "25.2693 .. 25.2999 .. 25.2621" where T turns between the ends, in the order along the family.
std::string interval_text(const archive::Archive& atlas, const Told& by, std::size_t family, double from, double to,
                          std::size_t first, std::size_t last) {
  const auto& values = atlas.orbits().reals(by.column);
  std::vector<std::string> places{fmt::format("{:.6g}", from)};
  const auto add = [&](double value) {
    const std::string text = fmt::format("{:.6g}", value);
    if (text != places.back()) places.push_back(text);
  };
  double before = from;
  bool rising = false;
  bool moves = false;
  const auto pass = [&](double value, std::size_t orbit_before) {
    if (std::abs(value - before) <= shown_change * std::abs(value)) return;
    if (moves && rising != (value > before)) add(turn_near(atlas, by, family, orbit_before));
    moves = true;
    rising = value > before;
    before = value;
  };
  for (std::size_t orbit = first; orbit <= last; ++orbit) pass(values[orbit], orbit - 1);
  pass(to, last);
  add(to);
  if (places.size() <= most_turns + 2) return fmt::format("{}", fmt::join(places, " .. "));
  const auto [least, most] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                                 values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  return fmt::format("{} .. {} (within {:.6g} .. {:.6g}, turning {} times)", places.front(), places.back(), *least,
                     *most, places.size() - 2);
}

}  // namespace

std::string stability_text(const archive::Archive& atlas, std::size_t family) {
  const OrbitStability stability(atlas);
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
  const auto end = first + static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
  const auto& steps = atlas.orbits().integers("step");
  if (first == end) return "";
  const Told by = told_by(atlas, first, end);
  const auto& values = atlas.orbits().reals(by.column);
  const Course course = course_of(values, first, end);
  const bool is_told = course.rises != course.falls;  // which orbit is meant
  std::vector<std::string> intervals;
  std::size_t known = 0;
  std::size_t stable = 0;
  std::size_t begin = first;  // of the interval under way
  for (std::size_t orbit = first; orbit <= end; ++orbit) {
    const std::optional<bool> here = orbit < end ? stability.of(orbit) : std::nullopt;
    known += here.has_value() ? 1 : 0;
    stable += here.value_or(false) ? 1 : 0;
    if (here.value_or(false)) continue;
    if (orbit > begin) {
      const double from = begin == first ? values[begin] : boundary(atlas, by, family, begin, begin - 1);
      const double to = orbit == end ? values[orbit - 1] : boundary(atlas, by, family, orbit - 1, orbit);
      intervals.push_back(interval_text(atlas, by, family, from, to, begin, orbit - 1));
      if (!is_told) intervals.back() += fmt::format(" (steps {} to {})", steps[begin], steps[orbit - 1]);
    }
    begin = orbit + 1;
  }
  if (known == 0) return "";
  if (stable == 0) return "unstable";
  if (stable == end - first) return "stable";
  if (intervals.size() > most_intervals) {
    intervals.resize(most_intervals);
    intervals.emplace_back("...");
  }
  return fmt::format("stable {} {}", by.name, fmt::join(intervals, ", "));
}

}  // namespace orbweaver::report
