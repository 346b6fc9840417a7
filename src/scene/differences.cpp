#include "orbweaver/scene/differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "fields.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"
#include "system_section.hpp"

namespace orbweaver::scene {

namespace {

struct Value {
  std::string key;
  std::string text;
  std::optional<LimitKey> limit = std::nullopt;
  double lower = 0.0;  ///< of a limit
  double upper = 0.0;
  std::optional<double> length = std::nullopt;  ///< whose unit depends on the system
};

bool is_same(const Value& a, const Value& b) { return a.length && b.length ? a.length == b.length : a.text == b.text; }

std::string text_of(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

// The shortest number of degrees that reads back as this angle.
std::string degrees_text(double angle) {
  for (int digits = 1; digits <= 17; ++digits) {
    std::string text = fmt::format("{:.{}g}", degrees(angle), digits);
    if (const auto value = parse_number(text); value && radians(*value) == angle) return text;
  }
  return fmt::format("{}rad", angle);
}

std::string angle_with_unit(double angle) {
  const std::string text = degrees_text(angle);
  return text.ends_with("rad") ? text : text + "deg";
}

std::string name_of(Certificate certificate) {
  switch (certificate) {
    case Certificate::automatic: return "automatic";
    case Certificate::none: return "none";
    case Certificate::closure: return "closure";
    case Certificate::full: break;
  }
  return "full";
}

template <class Items, class Text>
std::string list_text(const Items& items, const Text& text) {
  std::string list;
  for (const auto& item : items) list += (list.empty() ? "" : ", ") + text(item);
  return "[" + list + "]";
}

std::string range_text(double from, double to) { return list_text(std::array{from, to}, text_of); }

/// What it holds, where that is known: it may have been moved.
std::string file_text(const StartFile& file) { return file.hash.empty() ? file.path : file.hash; }

// All keys of a scene with their values, the ones it does not give included.
class Values {
 public:
  explicit Values(const Scene& scene) : _system(bound_system(scene.system)) {
    add("name", scene.name);
    add_system(scene.system);
    add_starts(scene);
    add_continuation(scene.continuation);
    add_moving(scene.system.moving);
    add_limit("survey.depth", LimitKey::depth, scene.survey.depth);
    add("survey.subharmonics", scene.survey.subharmonics);
    add("survey.spectrum", scene.survey.spectrum == Spectrum::all ? "all" : "events");
    add("survey.team_size", scene.survey.team_size);
    add("compute.stability", scene.compute.stability ? "true" : "false");
    add("compute.certificate", name_of(scene.compute.certificate));
    add_limits(scene.limits);
    add("events.periods", list_text(scene.events.periods, text_of));
    add("events.energies", list_text(scene.events.energies, text_of));
    add("loci", list_text(scene.loci, [](const Loci& loci) {
          const std::string of = list_text(loci.of, [](Loci::Of kind) { return scene::name_of(kind); });
          return fmt::format("{{of: {}, free: [{}], range: {}}}", of, loci.free, range_text(loci.from, loci.to));
        }));
    add("section.coordinate", scene.section.coordinate);
    add("section.value", coordinate_text(scene.section.value, index_of(scene.section.coordinate)));
    add("output.flush_seconds", scene.output.flush_seconds);
    add("output.flush_orbits", scene.output.flush_orbits);
  }

  [[nodiscard]] const std::vector<Value>& get() const noexcept { return _values; }

 private:
  void add(const std::string& key, const std::string& text) { _values.push_back({key, text}); }
  void add(const std::string& key, double value) { add(key, text_of(value)); }
  void add_range(const std::string& key, double from, double to) { add(key, range_text(from, to)); }
  void add_length(const std::string& key, double length) {
    const bool angles = _system->structure().has_angles();
    _values.push_back({.key = key, .text = angles ? angle_with_unit(length) : text_of(length), .length = length});
  }
  void add_limit(const std::string& key, LimitKey limit, double value) {
    _values.push_back({key, text_of(value), limit, 0.0, value});
  }
  void add_limits(const std::string& key, LimitKey limit, double from, double to) {
    _values.push_back({key, list_text(std::array{from, to}, text_of), limit, from, to});
  }

  void add_guard(const std::string& name, const std::map<std::string, double>& guards) {
    const auto given = guards.find(name);
    const double least = given == guards.end() ? 0.0 : given->second;
    _values.push_back({"limits.guards." + name, given == guards.end() ? "" : text_of(least), LimitKey::guards, least,
                       std::numeric_limits<double>::infinity()});
  }

  void add_system(const SystemChoice& choice) {
    add("system.name", choice.name);
    for (const systems::Parameter& parameter : known_parameters(info_of(choice), choice)) {
      const auto given = choice.parameters.find(parameter.name);
      add("system.parameters." + parameter.name, given == choice.parameters.end() ? parameter.standard : given->second);
    }
    for (const std::string& name : scale_names(*_system)) {
      const auto given = choice.scales.find(name);
      add("system.scales." + name, given == choice.scales.end() ? "auto" : text_of(given->second));
    }
    add("system.effects", list_text(std::set(choice.effects.begin(), choice.effects.end()), std::identity{}));
  }

  void add_starts(const Scene& scene) {
    const FixedPoints& points = scene.fixed_points;
    auto grid = points.grid;
    if (!grid.empty()) grid.resize(_system->info().state_names.size(), {0.0});
    std::size_t index = 0;
    add("starts.fixed_points.grid", list_text(grid, [&](const std::vector<double>& values) {
          const std::size_t coordinate = index++;
          return list_text(values, [&](double value) { return coordinate_text(value, coordinate); });
        }));
    std::set<std::string> names;
    for (const FixedPoints::Names& named : points.names)
      names.insert(fmt::format("{}: {}", point_text(named.point), list_text(named.names, std::identity{})));
    add("starts.fixed_points.names", list_text(names, std::identity{}));
    add("starts.fixed_points.letters", list_text(points.letters, [](const auto& family_and_letters) {
          return family_and_letters.first + ": " + family_and_letters.second;
        }));
    const Sweep& sweep = scene.sweep;
    add("starts.sweep.period", sweep.period ? range_text(sweep.period->from, sweep.period->to) : "auto");
    add("starts.sweep.step", sweep.step ? text_of(*sweep.step) : "auto");
    add("starts.states", list_text(scene.states, [&](const StateStart& start) {
          return fmt::format("{{state: {}, period: {}, name: {}}}", point_text(start.state), text_of(start.period),
                             start.name);
        }));
    add("starts.orbits", list_text(scene.orbits, [](const OrbitStart& start) {
          return fmt::format("{{archive: {}, family: {}, near: {{{}: {}}}, name: {}}}", file_text(start.archive),
                             start.family, name_of(start.near), text_of(start.value), start.name);
        }));
    add("starts.loops", list_text(scene.loops, [](const LoopStart& start) {
          return fmt::format("{{file: {}, period: {}, name: {}}}", file_text(start.file), text_of(start.period),
                             start.name);
        }));
    const auto add_of_returns = [&](const char* key, const auto& text) {
      add(fmt::format("starts.recurrences.{}", key), scene.recurrences ? text(*scene.recurrences) : "");
    };
    add_of_returns("state", [&](const Recurrences& given) { return point_text(given.state); });
    add_of_returns("time", [](const Recurrences& given) { return text_of(given.time); });
    add_of_returns("period", [](const Recurrences& given) { return range_text(given.period_from, given.period_to); });
    add_of_returns("tolerance", [](const Recurrences& given) { return text_of(given.tolerance); });
    add_of_returns("most", [](const Recurrences& given) { return fmt::format("{}", given.most); });
  }

  void add_moving(const systems::FamilyScalars& moving) {
    using Hold = systems::FamilyScalars::Hold;
    add("continuation.free", moving.free.empty() ? "" : moving.free.front());
    add("continuation.hold", moving.hold == Hold::nothing ? "" : moving.hold == Hold::energy ? "energy" : "period");
  }

  void add_continuation(const Continuation& continuation) {
    const auto& step = continuation.fixed_step;
    if (step)
      add_length("continuation.step", *step);
    else
      add("continuation.step", "adaptive");
    // The default is a number of the survey's scales, which in a system without angles are not the units.
    if (continuation.start_is_given || _system->structure().has_angles())
      add_length("continuation.start", continuation.start_amplitude);
    else
      _values.push_back({.key = "continuation.start", .text = "auto", .length = continuation.start_amplitude});
    add("continuation.tolerance", continuation.tolerance);
    add_range("continuation.cutoff", continuation.cutoff_from, continuation.cutoff_to);
    add("continuation.corrector", continuation.corrector);
  }

  void add_limits(const Limits& limits) {
    add_limit("limits.period", LimitKey::period, limits.period);
    add_limits("limits.energy", LimitKey::energy, limits.energy_from, limits.energy_to);
    add_limits("limits.parameter", LimitKey::parameter, limits.parameter_from, limits.parameter_to);
    for (const std::string& name : _system->structure().guard_names()) add_guard(name, limits.guards);
    add_limit("limits.families", LimitKey::families, limits.families);
    add_limit("limits.steps", LimitKey::steps, limits.steps);
    add("limits.time", limits.time);
    add("limits.task_time", limits.task_time);
  }

  [[nodiscard]] std::size_t index_of(const std::string& coordinate) const {
    const auto& names = _system->info().state_names;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), coordinate) - names.begin());
  }

  [[nodiscard]] std::string coordinate_text(double value, std::size_t coordinate) const {
    return _system->structure().is_angle(coordinate) ? degrees_text(value) : text_of(value);
  }

  [[nodiscard]] std::string point_text(std::vector<double> point) const {
    point.resize(_system->info().state_names.size(), 0.0);
    std::size_t index = 0;
    return list_text(point, [&](double value) { return coordinate_text(value, index++); });
  }

  std::shared_ptr<const systems::System> _system;
  std::vector<Value> _values;
};

bool is_inside(const std::string& path, const std::string& outer) {
  return path.starts_with(outer) && (path.size() == outer.size() || path[outer.size()] == '.');
}

std::string value_text(const YAML::Node& node) {
  if (node.IsSequence()) return list_text(node, value_text);
  if (node.IsMap())
    return list_text(node, [](const auto& entry) { return value_text(entry.first) + ": " + value_text(entry.second); });
  if (!node.IsScalar()) return "";
  const auto number = parse_number(node.Scalar());
  return number ? text_of(*number) : node.Scalar();
}

// What stands in the text outside the keys in `known`. `scales: auto` says what the keys within it say.
void add_unknown(const YAML::Node& node, const std::string& path, const std::vector<Value>& known,
                 std::vector<Value>& unknown) {
  for (const auto& entry : node) {
    const std::string key = (path.empty() ? "" : path + ".") + value_text(entry.first);
    const bool is_map = entry.second.IsMap();
    if (std::any_of(known.begin(), known.end(), [&](const Value& value) {
          return is_inside(key, value.key) || (!is_map && is_inside(value.key, key));
        }))
      continue;
    if (is_map)
      add_unknown(entry.second, key, known, unknown);
    else
      unknown.push_back({key, value_text(entry.second)});
  }
}

std::vector<Value> values_of(const Scene& scene) {
  std::vector<Value> values = Values(scene).get();
  std::vector<Value> unknown;
  values.push_back({"system.model_file", ""});  // what it holds counts
  const YAML::Node root = parse_document(scene.text, "scene", true);
  add_unknown(root, "", values, unknown);
  if (root["system"]["model_file"]) add_unknown(parse_document(scene.model, "model", true), "system", values, unknown);
  values.insert(values.end(), unknown.begin(), unknown.end());
  return values;
}

bool is_free(const std::string& key) {
  return key == "name" || key == "limits.time" || key == "limits.task_time" || key == "survey.team_size" ||
         key.starts_with("output.");
}

Change change_of(const Value& before, const Value& now) {
  if (is_free(before.key)) return Change::free;
  if (!before.limit || !now.limit) return Change::other;
  return now.lower <= before.lower && now.upper >= before.upper ? Change::widened : Change::narrowed;
}

Value find(const std::vector<Value>& values, const std::string& key) {
  const auto found = std::find_if(values.begin(), values.end(), [&](const Value& value) { return value.key == key; });
  return found == values.end() ? Value{key, ""} : *found;
}

}  // namespace

std::vector<Difference> differences(const Scene& before, const Scene& now) {
  const std::vector<Value> old_values = values_of(before);
  const std::vector<Value> new_values = values_of(now);
  std::vector<std::string> keys;
  for (const auto* values : {&old_values, &new_values})
    for (const Value& value : *values)
      if (std::find(keys.begin(), keys.end(), value.key) == keys.end()) keys.push_back(value.key);
  std::vector<Difference> result;
  for (const std::string& key : keys) {
    const Value old_value = find(old_values, key);
    const Value new_value = find(new_values, key);
    if (!is_same(old_value, new_value))
      result.push_back({key, old_value.limit, old_value.text, new_value.text, change_of(old_value, new_value)});
  }
  return result;
}

}  // namespace orbweaver::scene
