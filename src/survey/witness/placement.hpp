#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"
#include "tree/family_tree.hpp"

namespace orbweaver::survey {

/// Where a crossing lies that a branch has located beneath its end.
struct Placement {
  std::string branch;
  std::string family;      ///< key
  int side = 1;            ///< of the family, as in Lineage
  double arclength = 0.0;  ///< on the branch of that side (signed_arclength), in the scene's units
};

/// Looks for the families on which the crossings lie among those of the atlas, whose rows of /families have these keys
/// (sorted). Of several that are images of one another, the one at the branch's own equilibrium. Crossings that lie on
/// none are left out.
[[nodiscard]] std::vector<Placement> placements(const std::filesystem::path& atlas,
                                                const std::vector<std::string>& family_keys,
                                                const std::vector<FamilyTree::Unplaced>& unplaced,
                                                const std::shared_ptr<const systems::System>& system);

}  // namespace orbweaver::survey
