#pragma once

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

/// What the scene says of continuation, as options of a branch. `team`: ranks that divide its work; may be null.
[[nodiscard]] continuation::Options branch_options(const scene::Scene& scene, core::Team* team);

}  // namespace orbweaver::survey
