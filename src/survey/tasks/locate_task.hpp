#pragma once

#include <memory>

#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Null vectors that the multipliers at a crossing let expect in its sector, at most. Where an index only touches 2 or
/// -2, two crossings are one to rounding, and each has a null vector of its own.
[[nodiscard]] int expected_dimension(const systems::Structure& system, const spectrum::Stability& stability,
                                     const bifurcation::Sector& sector, bool touches);

/// Locates an event, finds its kernel and the directions in which families leave, and makes a start task of each that
/// the scene's depth and period allow. `team` divides the work; may be null.
[[nodiscard]] queue::TaskOutcome locate(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                                        const LocateWork& work, queue::TaskContext& context, core::Team* team);

}  // namespace orbweaver::survey
