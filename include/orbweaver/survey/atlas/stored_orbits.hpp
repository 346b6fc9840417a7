#pragma once

#include <cstddef>
#include <memory>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// The system of a scene, in the units of its parameters.
[[nodiscard]] std::shared_ptr<const systems::System> system_of(const scene::Scene& scene);

/// The scene of an archive, with the model that it holds. Throws InputError where this Orbweaver does not read it.
[[nodiscard]] scene::Scene scene_of(const archive::Archive& atlas);

/// The system of the archive's scene, told in the scales of the survey that wrote it: all 1 in an archive from before
/// there were any. Throws InputError where this Orbweaver does not read the scene.
[[nodiscard]] std::shared_ptr<const systems::System> scaled_system_of(const archive::Archive& atlas);
/// The scales alone; `system`: in its own units.
[[nodiscard]] systems::Scales scales_of(const archive::Header& header, const systems::System& system);

/// Row `orbit` of /orbits, in the scales of `system`.
[[nodiscard]] loop::Loop stored_loop(const archive::Archive& atlas, std::size_t orbit, const systems::System& system);

/// Stored orbits start in a standard phase, which may jump between two neighbours: the loop with the start, and as the
/// image, that brings it nearest to its neighbour, if that is twice as near as it stands.
[[nodiscard]] loop::Loop started_as(const systems::Structure& system, const loop::Loop& loop,
                                    const loop::Loop& neighbour);

}  // namespace orbweaver::survey
