#pragma once

#include <memory>
#include <utility>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "orbweaver/systems/system.hpp"
#include "state/payload_store.hpp"
#include "tasks/given_orbit_watch.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Does the survey's tasks on a rank; the rows of its orbits wait in `rows` for the next flush.
class Executor : public queue::Executor {
 public:
  /// `team`: ranks that divide the work of a task among them, all executing the same one. `store`: for the payloads of
  /// what comes of a task on its way, of which its state has many; not with a team, whose members' states must be
  /// alike. Both may be null.
  Executor(const scene::Scene& scene, std::shared_ptr<const systems::System> system, archive::Records& rows,
           core::Team* team = nullptr, PayloadStore* store = nullptr);

  /// The orbits that the scene gives, which branches watch for: before the first branch, on every rank that does one.
  void expect(GivenOrbits given) { _given = {_system, std::move(given), branch_options(_scene, _team)}; }
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override;
  void take_back_rows(bool flushed) override;

 private:
  [[nodiscard]] queue::TaskOutcome sweep(const SweepWork& work) const;
  [[nodiscard]] SweepOutcome small_oscillations(const SweepWork& work) const;

  const scene::Scene& _scene;
  std::shared_ptr<const systems::System> _system;
  archive::Records& _rows;
  core::Team* _team;
  PayloadStore* _store;
  GivenOrbitWatch _given;
  std::size_t _orbits_before = 0;  // of other tasks
  std::size_t _sections_before = 0;
};

}  // namespace orbweaver::survey
