#include "starts_section.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fields.hpp"
#include "fixed_points.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "sections.hpp"

namespace orbweaver::scene {

namespace {

/// Of all coordinates of `system`, angles in degrees.
std::vector<double> state_of(const std::vector<Field>& numbers, const systems::System& system) {
  std::vector<double> values;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = numbers[i].number({.example = "0.1"});
    values.push_back(system.structure().is_angle(i) ? radians(value) : value);
  }
  return values;
}

/// Of a system without some of its coordinates the state may be that of the whole one.
std::vector<double> read_state(const Field& state, const systems::System& system) {
  const auto d = static_cast<std::size_t>(system.dimension());
  const std::vector<Field> numbers = state.list("[0.1, 0]");
  const systems::System* whole = systems::whole_of(system);
  if (whole != nullptr && numbers.size() == whole->info().state_names.size()) {
    try {
      return systems::reduced_state(system, state_of(numbers, *whole));
    } catch (const core::InputError& error) {
      state.fail(error.what());
    }
  }
  if (numbers.size() != d)
    state.fail(
        fmt::format("{} numbers, for {}{}", d, fmt::join(system.info().state_names, ", "),
                    whole == nullptr ? "" : fmt::format(", or for {}", fmt::join(whole->info().state_names, ", "))),
        state.got(), "give every coordinate at t = 0");
  return state_of(numbers, system);
}

/// The keys that all must be there.
std::vector<Field> required(const Keys& keys, const Field& entry, const std::vector<std::string>& names,
                            std::string_view example) {
  std::vector<Field> fields;
  for (const std::string& name : names) {
    const auto found = keys.find(name);
    if (!found) entry.fail(fmt::format("the key `{}`", name), entry.got(), fmt::format("for example {}", example));
    fields.push_back(*found);
  }
  return fields;
}

std::string read_name(const Keys& keys) {
  const auto name = keys.find("name");
  return name ? name->text("Eight") : "";
}

double read_period(const Field& field) { return field.number({.lower = 0, .lower_open = true, .example = "6.3"}); }

void read_states(const Field& field, const systems::System& system, std::vector<StateStart>& states) {
  constexpr std::string_view example = "[{state: [0.1, 0], period: 6.3, name: Eight}]";
  for (const Field& entry : field.list(example)) {
    const Keys keys(entry, names_of_keys(entry.path()), example);
    const std::vector<Field> given = required(keys, entry, {"state", "period"}, example);
    states.push_back({read_state(given[0], system), read_period(given[1]), read_name(keys)});
  }
}

enum class Kind { atlas, table };

/// An atlas may be named by its survey's folder.
std::filesystem::path file_at(const std::filesystem::path& place, Kind kind, const Field& path) {
  std::filesystem::path file = place;
  try {
    if (kind == Kind::atlas) file = core::atlas_named(place);
  } catch (const core::InputError& error) {
    path.fail(error.what());
  }
  if (const std::string problem = core::input_problem(file); !problem.empty())
    path.fail("a file that can be read, told from the scene's folder", fmt::format("{}, which {}", path.got(), problem),
              "check the path");
  return file;
}

/// Of the file itself where it can be read, and then the one that stands beside it, if any.
StartFile read_file(Kind kind, const Field& path, const std::optional<Field>& hash,
                    const std::optional<std::filesystem::path>& folder) {
  StartFile file{path.text("other/atlas.h5", longest_path), {}, {}};
  if (hash) file.hash = hash->text("the hash that a stored scene has");
  if (!folder) return file;
  file.file = file_at(*folder / file.path, kind, path);
  std::string found;
  try {
    found = core::file_hash({file.file});
  } catch (const core::InputError& error) {
    path.fail(error.what());
  }
  if (hash && file.hash != found)
    hash->fail(fmt::format("a file with this hash, {}", file.hash), fmt::format("one with {}", found),
               "give the file that it was, or remove the hash to start from this one");
  file.hash = found;
  return file;
}

void read_orbits(const Field& field, const std::optional<std::filesystem::path>& folder,
                 std::vector<OrbitStart>& orbits) {
  constexpr std::string_view example = "[{archive: other/atlas.h5, family: In-Phase, near: {period: 9}}]";
  for (const Field& entry : field.list(example)) {
    const Keys keys(entry, names_of_keys(entry.path()), example);
    const std::vector<Field> given = required(keys, entry, {"archive", "family", "near"}, example);
    OrbitStart start;
    start.archive = read_file(Kind::atlas, given[0], keys.find("hash"), folder);
    start.family = given[1].text("In-Phase");
    start.name = read_name(keys);
    const Keys near(given[2], names_of_keys(given[2].path()), "near: {period: 9}");
    int count = 0;
    for (const OrbitStart::Near kind : {OrbitStart::Near::period, OrbitStart::Near::energy, OrbitStart::Near::step})
      if (const auto value = near.find(name_of(kind))) {
        ++count;
        start.near = kind;
        start.value = kind == OrbitStart::Near::period ? read_period(*value) : value->number({.example = "0"});
      }
    if (count != 1) given[2].fail("one of `period`, `energy` and `step`", given[2].got(), "for example {period: 9}");
    orbits.push_back(std::move(start));
  }
}

void read_loops(const Field& field, const systems::System& system, const std::optional<std::filesystem::path>& folder,
                std::vector<LoopStart>& loops) {
  constexpr std::string_view example = "[{file: loop.csv, period: 6.3}]";
  for (const Field& entry : field.list(example)) {
    const Keys keys(entry, names_of_keys(entry.path()), example);
    const std::vector<Field> given = required(keys, entry, {"file", "period"}, example);
    LoopStart start;
    start.file = read_file(Kind::table, given[0], keys.find("hash"), folder);
    start.period = read_period(given[1]);
    start.name = read_name(keys);
    if (folder) {
      try {
        start.samples = read_loop_samples(start.file.file, system, start.period);
      } catch (const core::InputError& error) {
        given[0].fail(error.what());
      }
    }
    loops.push_back(std::move(start));
  }
}

Recurrences read_recurrences(const Field& field, const systems::System& system) {
  constexpr std::string_view example = "{state: [0.1, 0], time: 500, period: [1, 20]}";
  const Keys keys(field, names_of_keys(field.path()), example);
  const std::vector<Field> given = required(keys, field, {"state", "time", "period"}, example);
  Recurrences recurrences;
  recurrences.state = read_state(given[0], system);
  recurrences.time = given[1].number({.lower = 0, .lower_open = true, .example = "500"});
  std::tie(recurrences.period_from, recurrences.period_to) =
      given[2].range({.lower = 0, .lower_open = true, .example = "[1, 20]"});
  if (recurrences.period_to > recurrences.time)
    given[2].fail(fmt::format("periods up to `time`, {:g}", recurrences.time),
                  fmt::format("{:g}", recurrences.period_to), "a return takes a period: give a longer time");
  if (const auto tolerance = keys.find("tolerance"))
    recurrences.tolerance = tolerance->number({.lower = 0, .upper = 1, .lower_open = true, .example = "0.1"});
  if (const auto most = keys.find("most")) recurrences.most = most->integer({.lower = 1, .example = "50"});
  return recurrences;
}

/// Whether the text had it.
bool keep_hash(const StartFile& file, YAML::Node entry) {
  const bool had = static_cast<bool>(entry["hash"]);
  if (!had && !file.hash.empty()) entry["hash"] = file.hash;
  return had || file.hash.empty();
}

}  // namespace

std::string name_of(OrbitStart::Near near) {
  switch (near) {
    case OrbitStart::Near::period: return "period";
    case OrbitStart::Near::energy: return "energy";
    case OrbitStart::Near::step: break;
  }
  return "step";
}

void take_place(const Field& starts, SystemChoice& choice) {
  const std::shared_ptr<const systems::System> system = bound_system(choice);
  const systems::System* whole = systems::whole_of(*system);
  if (whole == nullptr || system->structure().symplectic) return;
  const std::vector<std::string>& coordinates = whole->info().state_names;
  const auto entry = [](const Field& map, const std::string& key) -> std::optional<Field> {
    for (const Field::Entry& found : map.entries("{}"))
      if (found.key.plain_scalar() == key) return found.value;
    return std::nullopt;
  };
  try {
    std::vector<std::vector<Field>> states;
    if (const auto points = entry(starts, "fixed_points"))
      if (const auto grid = entry(*points, "grid")) {
        std::vector<Field>& first = states.emplace_back();
        for (const Field& values : grid->list("[[1], [0]]"))
          if (const std::vector<Field> list = values.list("[1]"); !list.empty()) first.push_back(list.front());
      }
    if (const auto given = entry(starts, "states"))
      for (const Field& one : given->list("[{state: [1, 0], period: 6.3}]"))
        if (const auto state = entry(one, "state")) states.push_back(state->list("[1, 0]"));
    if (const auto given = entry(starts, "recurrences"))
      if (const auto state = entry(*given, "state")) states.push_back(state->list("[1, 0]"));
    for (const std::vector<Field>& state : states) {
      if (state.size() != coordinates.size()) continue;
      std::map<std::string, double> place;
      for (std::size_t i = 0; i < state.size(); ++i) place[coordinates[i]] = state[i].number({.example = "1"});
      choice.parameters.insert(place.begin(), place.end());
      return;
    }
  } catch (const core::InputError&) {
    return;
  }
}

void read_starts(const Field& field, const systems::System& system, const std::optional<std::filesystem::path>& folder,
                 Scene& scene) {
  const Keys keys(field, names_of_keys(field.path()), "starts: {fixed_points: {grid: [[0, 180], [0, 180]]}}");
  if (const auto points = keys.find("fixed_points")) read_fixed_points(*points, system, scene.fixed_points);
  if (const auto sweep = keys.find("sweep")) read_sweep(*sweep, scene.sweep);
  if (const auto states = keys.find("states")) read_states(*states, system, scene.states);
  if (const auto orbits = keys.find("orbits")) read_orbits(*orbits, folder, scene.orbits);
  if (const auto loops = keys.find("loops")) read_loops(*loops, system, folder, scene.loops);
  if (const auto recurrences = keys.find("recurrences")) scene.recurrences = read_recurrences(*recurrences, system);
}

bool keep_hashes(const Scene& scene, YAML::Node& root) {
  bool all = true;
  for (std::size_t n = 0; n < scene.orbits.size(); ++n)
    all = keep_hash(scene.orbits[n].archive, root["starts"]["orbits"][n]) && all;
  for (std::size_t n = 0; n < scene.loops.size(); ++n)
    all = keep_hash(scene.loops[n].file, root["starts"]["loops"][n]) && all;
  return all;
}

}  // namespace orbweaver::scene
