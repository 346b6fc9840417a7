#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/survey/tasks/work.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::survey {

/// What rank 0 knows of the families while the survey runs, and what it makes of it at the end: which branches are the
/// same curve from another end, names, parents, ends.
///
/// A branch that arrives at a crossing has come along one of the directions that leave there, so whatever starts in that
/// direction is the same branch run backwards. It is left out if the branch that arrives comes first in the order of depth,
/// then key (or if it does not arrive in turn); everything found along it is left out as well. `wanted` judges by what has
/// ended so far; what it has left out wrongly is run afterwards (Survey), so that the archive depends on tasks and outcomes
/// only, not on when they came.
class FamilyTree {
 public:
  FamilyTree(const scene::Scene& scene, const systems::Structure& system) : _scene(scene), _system(system) {}

  /// A task has ended: done, failed or stopped.
  void add(const queue::Task& task, const queue::TaskOutcome& outcome);
  /// False for a task whose branch is known to be another one's, or one family too many.
  [[nodiscard]] bool wanted(const queue::Task& task) const;

  struct Result {
    archive::Records tables;              ///< families and crossings, and what of the rows does not belong to them
    std::vector<FamilySummary> families;  ///< parents before children
    std::vector<std::string> failures;    ///< key and reason
    std::vector<std::string> remarks;
  };
  [[nodiscard]] Result resolve() const;

 private:
  struct Branch {
    Lineage lineage;
    std::string name;  ///< of a base
    IsotropyRecord isotropy;
    std::optional<BranchOutcome> outcome;
    bool failed = false;
    std::string reason;
  };
  /// Where a branch arrived: along which direction of which crossing.
  struct Meeting {
    std::string crossing;
    std::string family;
    int side = 1;
    double away = 0.0;  ///< of the orbit before, from the direction, in parts of its distance from the crossing
  };
  struct Family;

  [[nodiscard]] std::optional<Meeting> meeting_of(const Branch& branch, const LocateOutcome& crossing) const;
  using Keys = std::set<std::string>;
  /// The best of all, crossings on `dropped` branches left out.
  [[nodiscard]] std::optional<Meeting> meeting_of(const Branch& branch, const Keys& dropped) const;
  [[nodiscard]] std::vector<std::pair<std::string, const Branch*>> ordered_branches() const;
  [[nodiscard]] Keys dropped_without(const Keys& before) const;
  /// Branches that are others run backwards, and all that lies on them.
  [[nodiscard]] Keys dropped_branches() const;
  /// The others, as many families as the scene allows.
  [[nodiscard]] std::map<std::string, Branch> kept_branches(const Keys& dropped) const;
  [[nodiscard]] std::vector<Family> families_of(const std::map<std::string, Branch>& kept) const;
  void name_all(std::vector<Family>& families) const;
  void add_crossings(const std::map<std::string, Branch>& kept, Result& result,
                     std::map<std::string, int>& index) const;
  void add_families(const std::vector<Family>& families, const Keys& dropped,
                    const std::map<std::string, int>& crossing_index, Result& result) const;

  const scene::Scene& _scene;
  const systems::Structure& _system;
  std::map<std::string, Branch> _branches;            // by key
  std::map<std::string, LocateOutcome> _crossings;    // by key
  std::set<std::pair<double, std::string>> _leaving;  // those where families leave, by the period of the born orbits
  std::map<std::string, std::string> _failures;       // of locations: by the crossing's key
  mutable std::map<std::pair<std::string, std::string>, std::optional<Meeting>> _met;  // branch, crossing
};

}  // namespace orbweaver::survey
