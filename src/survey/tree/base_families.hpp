#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/given_orbits.hpp"

namespace orbweaver::survey {

/// Sweeps that have ended, by the key of their task.
using SweepsEnded = std::map<std::string, std::pair<queue::Task, queue::TaskOutcome>>;

/// A sweep for every equilibrium. Throws InputError if there is none, and where the system contradicts its structure
/// (systems::require_identities).
[[nodiscard]] std::vector<queue::Task> sweep_tasks(const scene::Scene& scene, const systems::System& system);

/// The branches of the families with which a survey begins, and the orbits among them that the scene gives.
struct BaseFamilies {
  std::vector<queue::Task> tasks;
  GivenOrbits given;
};

/// The families at equilibria in the order of their keys: equilibria sorted, longest period first; behind them those
/// of given orbits; no more than the scene allows. What was passed over or left out is remarked in the summary. Throws
/// InputError where the scene names more families than an equilibrium has.
[[nodiscard]] BaseFamilies base_families(const scene::Scene& scene, const systems::System& system,
                                         const SweepsEnded& sweeps, Summary& summary);

/// A survey that came to its end without any family has failed: says so, and what to do. One whose families all begin
/// beyond its limits has not, as wider limits go on from there, and is told so.
void require_families(const systems::System& system, const SweepsEnded& sweeps, Summary& summary);

/// An equilibrium whose sweep failed is a family without orbits, so that the archive says so.
void gather_failed_sweeps(const systems::System& system, const SweepsEnded& sweeps, Summary& summary,
                          archive::Records& tables);

}  // namespace orbweaver::survey
