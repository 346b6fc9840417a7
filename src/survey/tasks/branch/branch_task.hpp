#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "state/branch_state.hpp"
#include "state/payload_store.hpp"
#include "tasks/arrival.hpp"
#include "tasks/branch/branch_ends.hpp"
#include "tasks/branch/branch_events.hpp"
#include "tasks/branch/first_orbit.hpp"
#include "tasks/branch/followed_branch.hpp"
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
  [[nodiscard]] Units units() const { return Units(*_followed.system); }
  void begin(const std::string& state);
  [[nodiscard]] continuation::Ending follow();
  [[nodiscard]] BranchState state_at(const continuation::Frontier& frontier) const;
  void note_limits(const continuation::Ending& ending, const continuation::Frontier& before);
  void limited_by(int limits, const continuation::Frontier& before);
  void finish();
  bool take(const continuation::Orbit& orbit);
  bool jumped(const continuation::Orbit& from, const continuation::Orbit& to);
  bool arrive(const continuation::Orbit& orbit);
  [[nodiscard]] static bool is_nearly_two(const spectrum::Stability& stability);
  bool arrives_ahead();
  [[nodiscard]] std::optional<continuation::Ending> lost_in_rounding(const continuation::Orbit& orbit);
  void decide(continuation::Ending& ending) const;
  [[nodiscard]] continuation::Ending met() const;
  void solve_requested(const continuation::Orbit& orbit);
  void store(continuation::Orbit orbit, const std::optional<spectrum::Stability>& stability);

  FollowedBranch _followed;
  const GivenOrbitWatch& _given;
  archive::Records& _rows;
  queue::TaskContext& _context;
  PayloadStore* _store;

  continuation::Options _options;
  std::optional<continuation::Branch> _branch;
  bifurcation::SymmetryWatch _symmetry;
  FirstOrbit _first_orbit;
  BranchEvents _events;
  BranchEnds _ends;
  std::optional<certificate::Certifier> _certifier;                  // none: the branch leaves it to others
  std::optional<bifurcation::SymmetryWatch::SampledOrbit> _sampled;  // of the last orbit
  std::optional<Arrival> _arrival;                                   // between the last orbit and the next
  bool _may_arrive_ahead = false;                                    // no reversor holds the direction
  std::optional<spectrum::Stability> _last_stability;                // of the last orbit
  std::optional<spectrum::Stability> _stability_before;              // of the one before, where that is known
  bool _stopped = false;
};

}  // namespace orbweaver::survey
