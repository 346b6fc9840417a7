#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Where the means over time of families' states lie: a time shift does not change them, nor do repetitions. They tell
/// families apart that share period and level, before any loops are compared.
class FamilyMeans {
 public:
  /// `symmetries`: of the system. All must outlive it.
  FamilyMeans(const AtlasTree& tree, const systems::System& system, const loop::SymmetryGroup& symmetries)
      : _tree(tree), _system(system), _symmetries(symmetries), _boxes(tree.families.size()) {}

  /// Whether two families may have an orbit in common, or one an image of the other's under the symmetries.
  [[nodiscard]] bool may_meet(int family, int other) const;

 private:
  /// All means of a family and half a step beyond, by coordinate.
  struct Box {
    Eigen::VectorXd centre;
    Eigen::VectorXd half;
  };
  [[nodiscard]] const Box& box_of(int family) const;
  [[nodiscard]] Box measured(const TreeFamily& family) const;

  const AtlasTree& _tree;
  const systems::System& _system;
  const loop::SymmetryGroup& _symmetries;
  mutable std::vector<std::optional<Box>> _boxes;  // of families that were asked for
};

}  // namespace orbweaver::survey
