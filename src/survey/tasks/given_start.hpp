#pragma once

#include <memory>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// The unit direction in which only the last scalar of a family moves: the parameter, or T.
[[nodiscard]] loop::Tangent along_last_scalar(const loop::Loop& base);

/// The orbit near the one that `work` gives, with its symmetries; two starts, one to each side. Throws NumericalError
/// where Newton's method finds none; for a return of a trajectory the outcome says so instead.
[[nodiscard]] SweepOutcome given_start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                                       const SweepWork& work, core::Team* team);

}  // namespace orbweaver::survey
