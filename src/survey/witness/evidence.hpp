#pragma once

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "curve_index.hpp"
#include "family_means.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "orbweaver/survey/witness/finding.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/sweep_work.hpp"
#include "tree/tree_evidence.hpp"

namespace orbweaver::survey {

/// Where a family of small oscillations begins.
struct Oscillation {
  int place = 0;        ///< among all families of its equilibrium
  double period = 0.0;  ///< in units
};

/// What the witness knows beside the atlas: of rank 0.
struct WitnessInput {
  TreeEvidence tree;
  std::vector<std::string> family_keys;                ///< sorted: one a row of /families
  std::vector<int> crossing_rows;                      ///< of the tables' crossings, which `tree` counts
  std::vector<std::vector<double>> equilibria;         ///< by the index that keys begin with
  /// Of base families that do not begin at their equilibrium itself: the state and the parameter of the Hopf point.
  std::map<std::string, std::vector<double>> beginnings;
  std::vector<std::vector<KernelRecord>> kernels;      ///< of several oscillations, by the same index
  std::vector<std::vector<Oscillation>> oscillations;  ///< that were followed, by the same index
  double time_unit = 1.0;                              ///< of the kernels' periods
  std::vector<std::string> failures;                   ///< of sweeps: they have no branch
  std::vector<std::string> interrupted;                ///< tasks put aside, or not begun before a stop
  bool stopped_early = false;
};

/// All that checks look at.
struct Evidence {
  Evidence(const AtlasTree& tree_, std::shared_ptr<const systems::System> system_, const scene::Scene& scene_,
           WitnessInput input);

  const AtlasTree& tree;
  std::shared_ptr<const systems::System> system;
  const scene::Scene& scene;
  WitnessInput known;  ///< crossings are rows of the atlas
  loop::SymmetryGroup symmetries;
  CurveIndex index;
  FamilyMeans means;
  std::set<int> failed;  ///< rows of families that a failed task was about

  /// Row of the family with this key; -1: none.
  [[nodiscard]] int row_of(const std::string& key) const;
  [[nodiscard]] const TreeFamily& family(int row) const { return tree.families[static_cast<std::size_t>(row)]; }
  [[nodiscard]] const TreeCrossing& crossing(int row) const { return tree.crossings[static_cast<std::size_t>(row)]; }
  [[nodiscard]] const std::string& key(int row) const { return known.family_keys[static_cast<std::size_t>(row)]; }
  /// The equilibrium at which the family, or what it descends from, begins; -1: unknown.
  [[nodiscard]] int equilibrium_of(int row) const;
  /// Of what does not agree about a family: a failed task, or a stop, may be the reason.
  [[nodiscard]] Severity severity_about(int row) const;
  /// The largest difference of a coordinate, angles modulo whole turns.
  [[nodiscard]] double distance_between(std::span<const double> point, std::span<const double> other) const;
  /// Whether the map takes where one family, or what it descends from, begins to where the other does, modulo whole
  /// turns.
  [[nodiscard]] bool begins_at_image(const systems::AffineMap& map, int row, int other) const;
  /// Whether some symmetry of the system takes where one family begins to where the other does, which is elsewhere.
  [[nodiscard]] bool begin_at_images(int row, int other) const;

 private:
  /// The equilibrium, or the Hopf point with its parameter; empty: unknown.
  [[nodiscard]] std::vector<double> beginning_of(int row) const;
};

}  // namespace orbweaver::survey
