#pragma once

#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/sweep_work.hpp"

namespace orbweaver::survey {

/// The orbits that the scene gives: states, orbits of archives, loops, returns of a trajectory, in this order; with
/// index 0. Throws InputError for an archive that cannot be read, of another system, or without the family, and for a
/// stored scene, whose files have not been read.
[[nodiscard]] std::vector<SweepWork> given_starts(const scene::Scene& scene, const systems::System& system);

}  // namespace orbweaver::survey
