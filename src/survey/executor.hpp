#pragma once

#include <memory>

#include "orbweaver/archive/records.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/work.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Does the survey's tasks on a rank; the rows of its orbits wait in `rows` for the next flush.
class Executor : public queue::Executor {
 public:
  Executor(const scene::Scene& scene, std::shared_ptr<const systems::System> system, archive::Records& rows);

  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override;

 private:
  [[nodiscard]] queue::TaskOutcome sweep(const SweepWork& work) const;

  const scene::Scene& _scene;
  std::shared_ptr<const systems::System> _system;
  archive::Records& _rows;
};

/// What the scene says of continuation, as options of a branch.
[[nodiscard]] continuation::Options branch_options(const scene::Scene& scene);

}  // namespace orbweaver::survey
