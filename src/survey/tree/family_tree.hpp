#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "arrivals.hpp"
#include "family.hpp"
#include "family_limit.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/structure.hpp"
#include "pruning.hpp"
#include "tables.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

/// What rank 0 knows of the families while the survey runs, and what it makes of it at the end: which branches are the
/// same curve from another end, names, parents, ends.
///
/// A branch that arrives at a crossing has come along one of the directions that leave there (Arrivals), so whatever
/// starts in that direction is the same branch run backwards: one of the two is dropped, with everything found along it
/// (Pruning). `wanted` judges by what has ended so far; what it has left out wrongly is run afterwards (Survey), so
/// that the archive depends on tasks and outcomes only, not on when they came.
class FamilyTree {
 public:
  /// Tasks and scene are told in `units`, the tables are not.
  FamilyTree(const scene::Scene& scene, const systems::Structure& system, Units units = {})
      : _scene(scene), _system(system), _units(std::move(units)), _arrivals(system), _limit(scene.limits.families) {}

  /// A task has ended: done, failed or stopped. Throws MisuseError if its branch or crossing had before.
  void add(const queue::Task& task, const queue::TaskOutcome& outcome);
  /// False for a task whose branch is known to be another one's, or one family too many.
  [[nodiscard]] bool wanted(const queue::Task& task) const;

  /// A crossing that a branch which stays has located beneath its end, and that no other task has: its family is known
  /// once the orbits of all can be looked at.
  struct Unplaced {
    std::string branch;
    const ArrivalRecord* arrival = nullptr;
  };
  [[nodiscard]] std::vector<Unplaced> unplaced() const;
  /// The branch ends at the crossing that it has located, which lies at this arclength on that side of the family.
  void place(const std::string& branch, const std::string& family, int side, double arclength);

  using Result = TreeTables;
  [[nodiscard]] Result resolve() const;

 private:
  void add_branch(const std::string& key, EndedBranch branch);
  void add_crossing(LocateOutcome crossing);
  /// Those whose drop has changed count as a family, or no more.
  void count(const std::vector<std::string>& branches);
  /// Branches that are not dropped, of as many families as the scene allows.
  [[nodiscard]] std::vector<FamilySide> kept_branches() const;

  /// What became of a direction whose branch has not ended.
  [[nodiscard]] DirectionFate fate_of(const std::string& branch, const Lineage& lineage) const;

  const scene::Scene& _scene;
  const systems::Structure& _system;
  Units _units;
  EndedBranches _branches;
  Crossings _crossings;                          // without loops
  std::set<std::string> _not_begun;              // branches whose first orbit lies beyond the limits
  std::map<std::string, std::string> _failures;  // of locations: by the crossing's key
  std::map<std::string, std::string> _undecided;  // reasons by the key of an event that rounding hides
  std::map<std::string, LocusOutcome> _loci;      // by crossing and entry
  std::map<std::string, std::string> _locus_failures;
  Arrivals _arrivals;
  Pruning _pruning;
  FamilyLimit _limit;
};

}  // namespace orbweaver::survey
