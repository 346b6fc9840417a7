#pragma once

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/bifurcation/meetings.hpp"
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

  void go_on(bifurcation::DetectorState detector, const bifurcation::FoldWatch& folds, int count, double passed_one,
             std::vector<queue::Task> tasks);
  [[nodiscard]] const bifurcation::DetectorState& detector_state() const { return _detector.state(); }
  [[nodiscard]] const bifurcation::FoldWatch& folds() const { return _folds; }
  [[nodiscard]] int count() const { return _count; }
  /// The position behind which no multiplier has passed 1; NaN before one has.
  [[nodiscard]] double passed_one() const { return _passed_one; }
  [[nodiscard]] const std::vector<queue::Task>& tasks() const { return _tasks; }
  [[nodiscard]] std::vector<queue::Task> take_tasks() { return std::move(_tasks); }

  /// A fold may lie between the first orbit of a family that begins at an equilibrium and the next.
  void watch_from_rest(const continuation::Orbit& first);
  void detect(const continuation::Orbit& orbit, const std::optional<spectrum::Stability>& stability);
  /// Between two orbits: what the test functions at both do not show. Before `detect` of the second.
  void detect_meetings(const bifurcation::StabilityAt& from, const bifurcation::StabilityAt& to);
  void detect_zeros(const bifurcation::TestPoint& point);
  /// The branch meets another family at `meeting`, behind the orbit at `last`. A multiplier is 1 there, which is no
  /// event: on the way a function of that goes to zero like a power of the distance, as beside the birth, and counts
  /// only where rounding cannot have made it.
  void go_to_meeting(double last, double meeting);
  /// The test functions of the branch at an orbit, as they count there.
  [[nodiscard]] bifurcation::TestPoint test_point(double position, const loop::Loop& loop,
                                                  const std::optional<spectrum::Stability>& stability) const;
  /// What rounding hides beside an end is asked anew: a branch that goes on from a checkpoint does not know it.
  void forget_hidden();
  /// What only the family's end shows of test functions, from the stored orbits alone, whatever was probed before.
  void finish_zeros();

  /// Zeros between the birth, which is the first of `known`, and the first orbit. A function of the multiplier 1 goes
  /// to zero at the birth like a power of the distance, which is no event.
  void add_zeros_from_birth(const std::vector<bifurcation::Bracket>& brackets,
                            const std::vector<continuation::FamilyCurve::Known>& known);
  /// Zeros at an orbit from which both sides of a family begin; `known`: of both.
  void add_zeros_at_start(const std::vector<bifurcation::Bracket>& brackets,
                          const std::vector<continuation::FamilyCurve::Known>& known);
  /// A function is zero there to rounding, and no orbit on the other side says whether it passes.
  void add_untold_start();
  /// `way`: from this known orbit to the next.
  void add_paired_folds(std::size_t way);
  void add_folds(const std::vector<bifurcation::Fold>& folds,
                 const std::vector<continuation::FamilyCurve::Known>& known);
  /// A fold that the watch has found between the last orbit and another one, which may be no longer known. If a
  /// multiplier has passed 1 since, as at every fold of the parameter or the energy, that has a location of its own;
  /// without one where it turns is undecided.
  void add_watched(const bifurcation::Fold& fold);
  void add_event(const bifurcation::Event& event, double from, double to,
                 std::vector<continuation::FamilyCurve::Known> known);
  void add_missed(const bifurcation::MissedZeros& missed);
  /// Whether the orbit found nearest before a meeting does not show the multiplier 1 that is there; tells it.
  bool add_short_of_meeting(const bifurcation::TestPoint& nearest);

 private:
  void add_zeros(const std::vector<bifurcation::Bracket>& brackets);
  [[nodiscard]] bool is_hidden_beside_end(double way, const loop::Loop& loop) const;
  void watch_folds(double position, const loop::Loop& loop);
  [[nodiscard]] bool is_in_known(const bifurcation::Fold& fold) const;
  [[nodiscard]] std::optional<spectrum::Stability> stability_between(double position);
  [[nodiscard]] std::optional<bifurcation::TestPoint> probe(double position);

  FollowedBranch& _followed;
  PayloadStore* _store;
  bifurcation::Detector _detector;
  bifurcation::FoldWatch _folds;
  int _count = 0;
  double _passed_one = std::numeric_limits<double>::quiet_NaN();
  double _last = std::numeric_limits<double>::infinity();
  double _meeting = std::numeric_limits<double>::infinity();
  std::vector<queue::Task> _tasks;
  // Rounding leaves orbits the more open the nearer they are to the birth, or to the meeting: up to and from which
  // distance it is known.
  mutable double _hidden_to = 0.0;
  mutable double _told_from = std::numeric_limits<double>::infinity();
};

}  // namespace orbweaver::survey
