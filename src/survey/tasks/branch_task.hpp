#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "state/branch_state.hpp"
#include "state/payload_store.hpp"
#include "tasks/arrival.hpp"
#include "tasks/given_orbit_watch.hpp"
#include "tasks/payload/work.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

/// Follows one branch: rows of its orbits, of those at requested periods and energies, a task for each event on it, and
/// its end, also where it meets a more symmetric family. Goes on from a state, or gives it, after any orbit.
class BranchTask {
 public:
  /// `state`: that of queue::Task, possibly empty. `store`: for the payloads of what is found; may be null.
  BranchTask(const scene::Scene& scene, std::shared_ptr<const systems::System> system, BranchWork work,
             const std::string& state, const GivenOrbitWatch& given, archive::Records& rows,
             queue::TaskContext& context, core::Team* team, PayloadStore* store);

  [[nodiscard]] queue::TaskOutcome run();

 private:
  [[nodiscard]] Units units() const { return Units(*_system); }
  void begin(const std::string& state);
  [[nodiscard]] continuation::Ending follow();
  [[nodiscard]] BranchState state_at(const continuation::Frontier& frontier) const;
  void note_limits(const continuation::Ending& ending, const continuation::Frontier& before);
  void limited_by(int limits, const continuation::Frontier& before);
  void finish();
  bool take(const continuation::Orbit& orbit);
  /// Of any loop of the family; none where the scene asks for no multipliers.
  [[nodiscard]] std::optional<spectrum::Stability> asked_stability(const loop::Loop& loop) const;
  const std::optional<spectrum::Stability>& stability_at(const continuation::Orbit& orbit);
  bool jumped(const continuation::Orbit& from, const continuation::Orbit& to);
  [[nodiscard]] bool is_too_far(const continuation::Orbit& first);
  bool passes_index(const loop::Loop& small, const continuation::Orbit& first);
  [[nodiscard]] bool has_requested(const continuation::Orbit& first) const;
  [[nodiscard]] bool has_turned(const loop::Loop& small, const continuation::Orbit& first) const;
  bool arrive(const continuation::Orbit& orbit);
  [[nodiscard]] static bool is_nearly_two(const spectrum::Stability& stability);
  bool arrives_ahead();
  void decide(continuation::Ending& ending) const;
  [[nodiscard]] continuation::Ending met() const;
  void detect_zeros(const bifurcation::TestPoint& point);
  void detect(const continuation::Orbit& orbit, const std::optional<spectrum::Stability>& stability);
  void look_before_first();
  void detect_from_birth();
  void indices_from_birth(const std::vector<continuation::FamilyCurve::Known>& known);
  void add_missed(const bifurcation::MissedZeros& missed);
  void folds_from_birth(const std::vector<continuation::FamilyCurve::Known>& known);
  void folds_at_start();
  void look_behind_last();
  void add_behind(std::vector<continuation::CurvePoint>& places);
  [[nodiscard]] std::vector<continuation::Orbit> orbits_to_zeros(const std::vector<continuation::CurvePoint>& places);
  void add_folds(const std::vector<bifurcation::Fold>& folds,
                 const std::vector<continuation::FamilyCurve::Known>& known);
  void add_paired_folds(std::size_t way);
  void add_event(const bifurcation::Event& event, double from, double to,
                 std::vector<continuation::FamilyCurve::Known> known);
  void solve_requested(const continuation::Orbit& orbit);
  void store(continuation::Orbit orbit, const std::optional<spectrum::Stability>& stability);
  [[nodiscard]] bifurcation::TestPoint test_point(double position,
                                                  const std::optional<spectrum::Stability>& stability) const;
  [[nodiscard]] std::optional<bifurcation::TestPoint> probe(double position);

  const scene::Scene& _scene;
  std::shared_ptr<const systems::System> _system;
  BranchWork _work;
  const GivenOrbitWatch& _given;
  archive::Records& _rows;
  queue::TaskContext& _context;
  core::Team* _team;
  PayloadStore* _store;

  continuation::Options _options;
  continuation::Start _start;
  std::optional<continuation::Branch> _branch;
  continuation::FamilyCurve _curve;
  bifurcation::SymmetryWatch _symmetry;
  std::vector<bifurcation::TestFunction> _functions;
  std::optional<certificate::Certifier> _certifier;  // none: the branch leaves it to others
  bifurcation::Detector _detector;
  bifurcation::FoldWatch _folds;
  std::optional<continuation::Orbit> _last;
  std::optional<bifurcation::SymmetryWatch::SampledOrbit> _sampled;  // of the last orbit
  std::optional<Arrival> _arrival;                                   // between the last orbit and the next
  std::optional<bifurcation::TestPoint> _at_rest;                    // of an oscillation that is next to nothing
  bool _may_arrive_ahead = false;                                    // no reversor holds the direction
  std::optional<spectrum::Stability> _last_stability;                // of the last orbit
  std::optional<loop::Loop> _asked;                                  // the orbit whose stability was asked for last,
  std::optional<spectrum::Stability> _stability;                     // and its stability
  double _before_first = 0.0;  // arclength from the crossing to the first orbit, in the scene's units
  int _events = 0;
  BranchOutcome _outcome;
  std::vector<queue::Task> _children;
  bool _stopped = false;
};

}  // namespace orbweaver::survey
