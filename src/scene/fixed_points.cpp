#include "fixed_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "fields.hpp"
#include "orbweaver/systems/reduced_system.hpp"

namespace orbweaver::scene {

namespace {

constexpr double most_grid_points = 1e6;         // Newton's method from each on one rank; not measured
constexpr std::size_t most_named_points = 1000;  // each is held against all others
constexpr double same_angle = 1e-9;              // radians: two spellings of one angle in degrees differ by rounding

struct Examples {
  std::string_view grid;
  std::string_view point;
  std::string_view names;
};

Examples examples(const systems::System& system) {
  if (system.structure().has_angles()) return {"[[0, 180], [0, 180]]", "[0, 180]", "{[0, 180]: [Down-Up]}"};
  return {"[[0], [0]]", "[0, 0]", "{[0, 0]: [Straight]}"};
}

bool same_value(double a, double b, bool angle) {
  return angle ? std::abs(std::remainder(a - b, 2 * std::numbers::pi)) < same_angle : a == b;
}

bool same_point(const systems::System& system, const std::vector<double>& a, const std::vector<double>& b) {
  const auto at = [](const std::vector<double>& point, std::size_t i) { return i < point.size() ? point[i] : 0.0; };
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    if (!same_value(at(a, i), at(b, i), system.structure().is_angle(i))) return false;
  return true;
}

double read_value(const Field& field, bool angle) {
  const double value = field.number({.example = angle ? "180 (degrees)" : "0"});
  return angle ? radians(value) : value;
}

/// The coordinates of a system that is handed out with fewer, and which of them it has; empty where it has others.
struct Whole {
  const systems::System* system = nullptr;
  std::vector<std::size_t> kept;
};

/// Lists of as many entries as the whole system has coordinates are told in those.
Whole told_in(const systems::System& system, std::size_t entries) {
  Whole out{systems::whole_of(system), {}};
  if (out.system == nullptr || entries != out.system->info().state_names.size()) return {};
  const std::vector<std::string>& all = out.system->info().state_names;
  for (const std::string& name : system.info().state_names) {
    const auto found = std::find(all.begin(), all.end(), name);
    if (found == all.end()) return {};
    out.kept.push_back(static_cast<std::size_t>(found - all.begin()));
  }
  return out;
}

template <class T>
std::vector<T> kept_of(std::vector<T> all, const Whole& whole) {
  if (whole.system == nullptr) return all;
  std::vector<T> out;
  for (const std::size_t i : whole.kept) out.push_back(std::move(all[i]));
  return out;
}

void check_size(const Field& field, std::size_t size, const systems::System& system) {
  if (size == 0 || size > system.info().state_names.size())
    field.fail(fmt::format("1 to {} entries, for the coordinates {} in this order", system.dimension(),
                           fmt::join(system.info().state_names, ", ")),
               fmt::format("{}", size), "leave trailing coordinates out to have them 0");
}

/// The first place whose value stands at an earlier one too.
std::optional<std::size_t> repeated(const std::vector<double>& values, bool angle) {
  const auto folded = [&](std::size_t i) {
    return angle ? std::remainder(values[i], 2 * std::numbers::pi) : values[i];
  };
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return folded(i) < folded(j); });
  std::optional<std::size_t> first;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const auto [earlier, later] = std::minmax(order[n], order[(n + 1) % order.size()]);  // angles close the circle
    if (earlier != later && same_value(values[earlier], values[later], angle))
      first = std::min(first.value_or(later), later);
  }
  return first;
}

void read_grid(const Field& field, const systems::System& system, FixedPoints& points) {
  std::vector<Field> coordinates = field.list(examples(system).grid);
  const Whole whole = told_in(system, coordinates.size());
  for (std::size_t i = 0; i < coordinates.size() && whole.system != nullptr; ++i) {
    const bool is_kept = std::find(whole.kept.begin(), whole.kept.end(), i) != whole.kept.end();
    if (const std::size_t values = coordinates[i].list("[0]").size(); !is_kept && values != 1)
      coordinates[i].fail(
          fmt::format("one value of {}, which follows from what the system keeps", whole.system->info().state_names[i]),
          fmt::format("{}", values), "give a scene for each value of what is kept");
  }
  coordinates = kept_of(std::move(coordinates), whole);
  check_size(field, coordinates.size(), system);
  double count = 1;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const bool angle = system.structure().is_angle(i);
    std::vector<double> values;
    const std::vector<Field> items = coordinates[i].list(angle ? "[0, 180]" : "[0]");
    for (const Field& item : items) values.push_back(read_value(item, angle));
    if (const auto again = repeated(values, angle))
      items[*again].fail("a value that the list does not hold yet",
                         items[*again].got() + (angle ? " again (angles count modulo 360)" : " again"), "remove one");
    if (values.empty()) coordinates[i].fail("at least one value", "an empty list", "for example [0]");
    count *= static_cast<double>(values.size());
    points.grid.push_back(std::move(values));
  }
  if (count > most_grid_points)
    field.fail(fmt::format("at most {} grid points", most_grid_points), fmt::format("{}", count), "thin the lists out");
}

std::vector<double> read_point(const Field& key, const systems::System& system) {
  std::vector<Field> coordinates = key.list(examples(system).point);
  const Whole whole = told_in(system, coordinates.size());
  coordinates = kept_of(std::move(coordinates), whole);
  check_size(key, coordinates.size(), system);
  std::vector<double> point;
  for (const Field& coordinate : coordinates)
    point.push_back(read_value(coordinate, system.structure().is_angle(point.size())));
  return point;
}

void read_names(const Field& field, const systems::System& system, FixedPoints& points) {
  std::set<std::string> used;
  const std::vector<Field::Entry> entries = field.entries(examples(system).names, true);
  if (entries.size() > most_named_points)
    field.fail(fmt::format("names for at most {} fixed points", most_named_points), fmt::format("{}", entries.size()),
               "name fewer");
  for (const Field::Entry& entry : entries) {
    FixedPoints::Names named{.point = read_point(entry.key, system), .names = {}};
    for (const FixedPoints::Names& other : points.names)
      if (same_point(system, named.point, other.point))
        entry.key.fail("each fixed point once", "the same point again", "join the two lists of names");
    for (const Field& item : entry.value.list("[In-Phase, Out-Phase]")) {
      named.names.push_back(item.text("In-Phase"));
      if (!used.insert(named.names.back()).second)
        item.fail("a family name that is not used yet", item.got() + " again", "choose another name");
    }
    if (named.names.empty()) entry.value.fail("at least one name", "an empty list", "for example [In-Phase]");
    points.names.push_back(std::move(named));
  }
}

void check_letters(const Field& field, const std::string& letters) {
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  if (letters.empty() || letters.size() > 4 || !std::all_of(letters.begin(), letters.end(), is_letter))
    field.fail("1 to 4 letters from A-Z and a-z", field.got(),
               "for example `I`, so that its branches are IB, ID1, ...");
}

void read_letters(const Field& field, FixedPoints& points) {
  std::vector<std::string> families;
  for (const FixedPoints::Names& named : points.names)
    families.insert(families.end(), named.names.begin(), named.names.end());
  const std::set<std::string> known(families.begin(), families.end());
  std::set<std::string> used;
  for (const Field::Entry& entry : field.entries("letters: {In-Phase: I}")) {
    const std::string family = entry.key.path().substr(field.path().size() + 1);
    if (!known.contains(family)) {
      const std::string near = nearest(family, families);
      entry.key.fail(
          families.empty() ? "a family of `names`, which lists none" : "a family of `names`: " + alternatives(families),
          entry.key.got(), near.empty() ? "name it there first" : fmt::format("did you mean `{}`?", near));
    }
    const std::string letters = entry.value.text("I");
    check_letters(entry.value, letters);
    if (!used.insert(letters).second)
      entry.value.fail("letters that no other family has", entry.value.got() + " again", "choose others");
    points.letters[family] = letters;
  }
}

}  // namespace

void read_fixed_points(const Field& field, const systems::System& system, FixedPoints& points) {
  const Keys keys(field, names_of_keys(field.path()), "fixed_points: {grid: [[0, 180], [0, 180]]}");
  if (const auto grid = keys.find("grid")) read_grid(*grid, system, points);
  if (const auto names = keys.find("names")) read_names(*names, system, points);
  if (const auto letters = keys.find("letters")) read_letters(*letters, points);
}

}  // namespace orbweaver::scene
