#pragma once

#include <memory>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// The Hopf points on the curve of equilibria through `work.point`, as places where families start.
[[nodiscard]] SweepOutcome hopf_starts(const scene::Scene& scene, const systems::System& system, const SweepWork& work);

/// The equilibrium `work.point` of a driven system whose drive is at zero, while the phase turns once: the drive is
/// raised from there. Or where it rests under the drive, as when it is shaken along its own direction. The family goes
/// on to both sides of the parameter's value, unless that is a limit.
[[nodiscard]] SweepOutcome drive_start(const scene::Scene& scene, const systems::System& system, const SweepWork& work);

}  // namespace orbweaver::survey
