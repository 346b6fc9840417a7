#pragma once

#include <string>
#include <vector>

#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// A loop on a family, with what tells of an orbit; `arclength`: its position.
[[nodiscard]] continuation::Orbit orbit_of(const systems::System& system, const loop::Loop& loop, double arclength);

/// The orbits between two neighbours of a family that have the scene's requested periods (exactly) and energies (to
/// rounding), in their order along the family. A remark is made of each one that
/// cannot be had.
[[nodiscard]] std::vector<continuation::Orbit> requested_orbits(
    const scene::Scene& scene, const systems::System& system, continuation::FamilyCurve& family,
    const continuation::Orbit& from, const continuation::Orbit& to, std::vector<std::string>& remarks);

}  // namespace orbweaver::survey
