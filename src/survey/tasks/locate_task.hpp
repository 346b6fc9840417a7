#pragma once

#include <memory>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Locates an event, finds its kernel and the directions in which families leave, and makes a start task of each that
/// the scene's depth and period allow. `team` divides the work; may be null.
[[nodiscard]] queue::TaskOutcome locate(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                                        const LocateWork& work, queue::TaskContext& context, core::Team* team);

}  // namespace orbweaver::survey
