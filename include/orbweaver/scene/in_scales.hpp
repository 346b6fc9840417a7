#pragma once

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::scene {

/// The scales of a survey: those of `natural` that the scene does not give itself (`system.scales`).
[[nodiscard]] systems::Scales scales_of(const Scene& scene, const systems::System& system,
                                        const systems::Scales& natural);

/// What a length of the scene (`continuation.start`, `continuation.step`) is divided by. With angles a length is one of
/// angles, whose scale is 1; else it is told in the units of the coordinate with the largest scale.
[[nodiscard]] double scale_of_lengths(const systems::System& system, const systems::Scales& scales);

/// The scene for the same system told in `scales`: grid, names, section, periods, energies and lengths converted
/// (docs/mathematics.md, "Scales"); the scene itself where all are 1. Its text stays as it was.
[[nodiscard]] Scene in_scales(Scene scene, const systems::System& system, const systems::Scales& scales);

}  // namespace orbweaver::scene
