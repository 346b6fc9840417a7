#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// The system whose orbits are the surface in which the loci of an entry lie: one more parameter moves.
[[nodiscard]] std::shared_ptr<const systems::System> surface_of(const scene::SystemChoice& choice,
                                                                const systems::System& system, const scene::Loci& loci);

/// Follows a locus to both sides of its crossing. `team` divides the multipliers; may be null.
[[nodiscard]] queue::TaskOutcome follow_locus(const scene::Scene& scene, const systems::System& system,
                                              const LocusWork& work, queue::TaskContext& context, core::Team* team);

}  // namespace orbweaver::survey
