#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/queue/task.hpp"
#include "state/payload_store.hpp"
#include "tasks/branch/followed_branch.hpp"

namespace orbweaver::survey {

/// The events on a branch: zeros of its test functions and folds, each of which becomes a task that locates it.
class BranchEvents {
 public:
  /// `store`: for the payloads of the tasks; may be null.
  BranchEvents(FollowedBranch& followed, PayloadStore* store) : _followed(followed), _store(store) {}

  void go_on(bifurcation::DetectorState detector, const bifurcation::FoldWatch& folds, int count,
             std::vector<queue::Task> tasks);
  [[nodiscard]] const bifurcation::DetectorState& detector_state() const { return _detector.state(); }
  [[nodiscard]] const bifurcation::FoldWatch& folds() const { return _folds; }
  [[nodiscard]] int count() const { return _count; }
  [[nodiscard]] const std::vector<queue::Task>& tasks() const { return _tasks; }
  [[nodiscard]] std::vector<queue::Task> take_tasks() { return std::move(_tasks); }

  /// A fold may lie between the first orbit of a family that begins at an equilibrium and the next.
  void watch_from_rest(const continuation::Orbit& first);
  void detect(const continuation::Orbit& orbit, const std::optional<spectrum::Stability>& stability);
  void detect_zeros(const bifurcation::TestPoint& point);
  /// What only the family's end shows of test functions, from the stored orbits alone, whatever was probed before.
  void finish_zeros();

  /// `way`: from this known orbit to the next.
  void add_paired_folds(std::size_t way);
  void add_folds(const std::vector<bifurcation::Fold>& folds,
                 const std::vector<continuation::FamilyCurve::Known>& known);
  void add_event(const bifurcation::Event& event, double from, double to,
                 std::vector<continuation::FamilyCurve::Known> known);
  void add_missed(const bifurcation::MissedZeros& missed);

 private:
  [[nodiscard]] std::optional<bifurcation::TestPoint> probe(double position);

  FollowedBranch& _followed;
  PayloadStore* _store;
  bifurcation::Detector _detector;
  bifurcation::FoldWatch _folds;
  int _count = 0;
  std::vector<queue::Task> _tasks;
};

}  // namespace orbweaver::survey
