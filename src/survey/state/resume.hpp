#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "checkpoint.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/scales.hpp"

namespace orbweaver::survey {

/// The newest checkpoint in `folder` whose segments and journals are all there: on rank 0, the others only hear whether
/// there is one. Files that it does not list are removed. Collective. Throws InputError on all ranks if there are
/// checkpoints and none can be used, saying why not; `found` is false if there is none.
struct Found {
  bool found = false;
  Checkpoint checkpoint;
};
[[nodiscard]] Found find_checkpoint(const core::Communicator& comm, const std::filesystem::path& folder);

/// Whether nothing of the survey stays under `scene`, measured in `scales`: limits.parameter is wider, and its unit
/// another with it, or curves of equilibria were followed within it: the numbers of their Hopf points are others,
/// or a family that began at a limit has another side now. On rank 0 only.
[[nodiscard]] bool begins_again(const scene::Scene& scene, const systems::Scales& scales,
                                const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Makes `checkpoint` one of `scene`, whose limits may be wider: what ended at a limit that lies farther out now waits
/// again, and all that followed from where it ended is dropped. Reads every journal, and gives `take` the tasks that
/// have ended and stay so; journals from which something was dropped are written anew. A finished survey is one that
/// follows families again. On rank 0 only. Throws InputError that names the keys if the scenes differ in anything else.
void continue_with(const scene::Scene& scene, const std::filesystem::path& folder, Checkpoint& checkpoint,
                   const std::function<void(const EndedTask&)>& take);

/// Whether a file of this name is one of those that a checkpoint, its journals or their tasks list.
[[nodiscard]] bool is_listed_kind(const std::string& name);

/// Removes segments, journals and payloads that neither the checkpoint nor the previous one lists: they came after it,
/// or are not needed any more.
void remove_unlisted(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Of a survey that is over, whose last checkpoint is `checkpoint`: payloads that no resume can ask for go, the others
/// are moved into one file, and the checkpoints count on that. Where this cannot be done all stays as it is, with a
/// warning. On rank 0 only.
void keep_needed_payloads(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Sentences on the keys in which a survey of `before` cannot go on as one of `now`; empty: it can.
[[nodiscard]] std::string refusal(const scene::Scene& before, const scene::Scene& now);

}  // namespace orbweaver::survey
