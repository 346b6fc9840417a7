#pragma once

#include <span>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What the scene asks of the sweep at an equilibrium; `auto` becomes the range of its own oscillations. Throws as
/// starts::linear_modes does.
[[nodiscard]] starts::SweepOptions sweep_options(const scene::Scene& scene, const systems::System& system,
                                                 std::span<const double> point);

}  // namespace orbweaver::survey
