#pragma once

#include <memory>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Finds the first orbit along a direction: the branch's task is then its child. An orbit that is the crossing's own
/// family again is noticed, and other amplitudes are tried.
[[nodiscard]] queue::TaskOutcome start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                                       const StartWork& work, core::Team* team);

}  // namespace orbweaver::survey
