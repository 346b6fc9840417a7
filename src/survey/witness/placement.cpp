#include "witness/placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/survey/atlas/loop_check.hpp"
#include "tasks/payload/keys.hpp"
#include "tasks/units.hpp"
#include "witness/passing.hpp"
#include "witness/tolerance.hpp"

namespace orbweaver::survey {

std::vector<Placement> placements(const std::filesystem::path& atlas, const std::vector<std::string>& family_keys,
                                  const std::vector<FamilyTree::Unplaced>& unplaced,
                                  const std::shared_ptr<const systems::System>& system) {
  const archive::Archive archive(atlas);
  const AtlasTree tree(archive, witness_tolerance);
  const CurveIndex index(tree);
  const LoopCheck check(system);
  const Units units(*system);
  std::vector<Placement> found;
  for (const FamilyTree::Unplaced& one : unplaced) {
    const loop::Loop& orbit = one.arrival->beneath.front().orbit;
    const double action = continuation::action_of(*system, orbit) * units.action();
    const double period = orbit.period * units.time;
    const PlaceOfOrbit place{period, continuation::level_of(*system, orbit) * units.level(), action,
                             std::abs(action) / period};
    std::optional<Placement> best;
    for (const auto& [row, segment] : passing(tree, index, place)) {
      const std::string& key = family_keys[static_cast<std::size_t>(row)];
      const bool is_at_own = equilibrium_index(key) == equilibrium_index(one.branch);
      if (best && !is_at_own) continue;
      const TreeFamily& family = tree.families[static_cast<std::size_t>(row)];
      const auto arclength = check.arclength_of(orbit, tree, family, segment);
      if (!arclength) continue;
      const double birth = std::isnan(family.birth_arclength) ? 0.0 : family.birth_arclength;
      const bool is_other_side = *arclength < birth;
      best = Placement{one.branch, key, is_other_side ? -1 : 1, is_other_side ? *arclength - birth : *arclength};
      if (is_at_own) break;
    }
    if (best) found.push_back(std::move(*best));
  }
  return found;
}

}  // namespace orbweaver::survey
