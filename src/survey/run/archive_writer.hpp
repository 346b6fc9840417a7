#pragma once

#include "orbweaver/core/mpi/communicator.hpp"
#include "state/checkpoint.hpp"
#include "tree/base_families.hpp"
#include "tree/family_tree.hpp"

namespace orbweaver::survey {

[[nodiscard]] archive::Header header_of(const scene::Scene& scene, const systems::System& system);

/// Fills the summary from what has ended and what `checkpoint` says was under way, and, if `summary.archived` says so,
/// makes the archive `summary.atlas` of it and of the segments, with what the witness says of it. Where that was told
/// to stop, there is none, and the survey has stopped early. Collective; only rank 0's arguments count.
void write_archive(const core::Communicator& comm, const scene::Scene& scene,
                   const std::shared_ptr<const systems::System>& system, const Checkpoint& checkpoint, FamilyTree& tree,
                   const SweepsEnded& sweeps, Summary& summary);

}  // namespace orbweaver::survey
