#pragma once

#include <string>
#include <vector>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/task.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Everything from which a branch goes on after an orbit, to the same bits as without a break.
struct BranchState {
  static constexpr const char* payload_name = "branch state";
  continuation::Frontier frontier;
  std::vector<continuation::FamilyCurve::Known> known;  ///< the last orbits
  bifurcation::DetectorState detector;
  bifurcation::FoldWatch folds;
  continuation::Orbit last;
  int events = 0;
  double passed_one = 0.0;            ///< as of BranchEvents
  BranchOutcome outcome;              ///< so far
  std::vector<queue::Task> children;  ///< so far

  static constexpr int wire_version = 3;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, frontier, known, detector, folds, last, events, passed_one, outcome, children);
  }
};

[[nodiscard]] std::string pack(const BranchState& state);
/// Throws EnvironmentError as the other unpacks do (work.hpp).
[[nodiscard]] BranchState unpack_branch_state(const std::string& bytes);

}  // namespace orbweaver::survey
