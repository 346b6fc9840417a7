#include "orbweaver/report/compare/comparison.hpp"

#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compare/family_differences.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::report {

namespace {

AtlasSize size_of(const archive::Archive& atlas) {
  return {atlas.path().string(), atlas.families().rows(), atlas.orbits().rows(), atlas.crossings().rows()};
}

std::optional<scene::Scene> scene_of(const archive::Archive& atlas) {
  try {
    return survey::scene_of(atlas);
  } catch (const core::InputError&) {
    return std::nullopt;
  }
}

std::string text_of(const std::string& system, const std::map<std::string, double>& parameters,
                    const std::vector<std::string>& effects) {
  std::vector<std::string> words;
  for (const auto& [name, value] : parameters) words.push_back(fmt::format("{} = {}", name, value));
  words.insert(words.end(), effects.begin(), effects.end());
  return fmt::format("{} ({})", system, fmt::join(words, ", "));
}

std::string text_of(const scene::Scene& scene) {
  const auto system = survey::system_of(scene);
  return text_of(system->info().name, system->parameters(), scene.system.effects);
}

/// As the head says it.
std::string text_of(const archive::Header& header) {
  std::map<std::string, double> parameters;
  for (std::size_t i = 0; i < header.parameter_names.size(); ++i)
    parameters[header.parameter_names[i]] = header.parameter_values[i];
  return text_of(header.system, parameters, header.effects);
}

// What makes the two atlases ones of different systems; empty: nothing.
std::string other_system(const archive::Header& a, const archive::Header& b, const std::string& system_a,
                         const std::string& system_b) {
  if (a.state_names != b.state_names || a.winding_names != b.winding_names)
    return fmt::format("coordinates are {} in A, {} in B", fmt::join(a.state_names, ", "),
                       fmt::join(b.state_names, ", "));
  if (a.pairs != b.pairs || a.symplectic != b.symplectic) return "orbits have another number of multipliers";
  if (system_a != system_b) return fmt::format("the system is {} in A, {} in B", system_a, system_b);
  return "";
}

}  // namespace

std::string_view name_of(DifferenceKind kind) {
  switch (kind) {
    case DifferenceKind::system: return "system";
    case DifferenceKind::only_in_a: return "only-in-a";
    case DifferenceKind::only_in_b: return "only-in-b";
    case DifferenceKind::birth: return "birth";
    case DifferenceKind::name: return "name";
    case DifferenceKind::isotropy: return "isotropy";
    case DifferenceKind::orbits: return "orbits";
    case DifferenceKind::range: return "range";
    case DifferenceKind::loop: return "loop";
    case DifferenceKind::end_reason: return "end-reason";
    case DifferenceKind::end_target: return "end-target";
    case DifferenceKind::end_place: return "end-place";
    case DifferenceKind::crossing_only_in_a: return "crossing-only-in-a";
    case DifferenceKind::crossing_only_in_b: return "crossing-only-in-b";
    case DifferenceKind::crossing_place: return "crossing-place";
    case DifferenceKind::crossing_kernel: return "crossing-kernel";
  }
  return "unknown";
}

Comparison compare(const archive::Archive& a, const archive::Archive& b, const CompareOptions& options) {
  Comparison result;
  result.a = size_of(a);
  result.b = size_of(b);
  const std::optional<scene::Scene> scene_a = scene_of(a);
  const std::optional<scene::Scene> scene_b = scene_of(b);
  const std::optional<scene::Scene>& known = scene_a ? scene_a : scene_b;
  const std::shared_ptr<const systems::System> system = known ? survey::system_of(*known) : nullptr;
  std::string name_a = text_of(a.header());
  std::string name_b = text_of(b.header());
  if (scene_a && scene_b) {
    name_a = text_of(*scene_a);
    name_b = text_of(*scene_b);
    for (const scene::Difference& difference : scene::differences(*scene_a, *scene_b))
      result.notes.push_back(
          fmt::format("scenes differ: {} is {} in A, {} in B", difference.key, difference.before, difference.now));
  } else {
    result.notes.push_back(
        fmt::format("{} the formulas are missing, or its scene is not one that this Orbweaver reads{}",
                    !scene_a && !scene_b ? "of A and of B"
                    : scene_a            ? "of B"
                                         : "of A",
                    known ? "" : ": loops are compared where both have an orbit at one place"));
    if (a.header().scene != b.header().scene) result.notes.emplace_back("scenes differ");
  }
  if (a.header().orbweaver_version != b.header().orbweaver_version)
    result.notes.push_back(fmt::format("written by Orbweaver {} (A) and {} (B)", a.header().orbweaver_version,
                                       b.header().orbweaver_version));
  if (const std::string other = other_system(a.header(), b.header(), name_a, name_b); !other.empty()) {
    result.differences.push_back({DifferenceKind::system, "", "", other});
    return result;
  }
  const AtlasTree tree_a(a, options.tolerance);
  const AtlasTree tree_b(b, options.tolerance);
  const LoopCheck loops(system ? systems::scaled(system, survey::scales_of((scene_a ? a : b).header(), *system))
                               : system);
  const TreeMatch match = match_trees(tree_a, tree_b, loops);
  FamilyDifferences(tree_a, tree_b, match, loops, options, result).run();
  return result;
}

}  // namespace orbweaver::report
