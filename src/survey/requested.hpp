#pragma once

#include <vector>

#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// The orbits between two neighbours of a family that have the scene's requested periods (exactly) and energies (to
/// rounding), in their order along the family. Those that cannot be converged are left out.
[[nodiscard]] std::vector<continuation::Orbit> requested_orbits(const scene::Scene& scene,
                                                                const systems::System& system,
                                                                continuation::FamilyCurve& family,
                                                                const continuation::Orbit& from,
                                                                const continuation::Orbit& to);

}  // namespace orbweaver::survey
