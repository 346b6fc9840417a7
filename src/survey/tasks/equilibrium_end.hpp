#pragma once

#include <string>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// The equilibrium at which a branch ends whose orbits shrink to a point.
struct EquilibriumEnd {
  int index = -1;    ///< among the survey's equilibria; -1: none of them
  std::string text;  ///< "Equilibrium 2, th1 = 180 deg, th2 = 0 deg"
};

/// The equilibrium that Newton's method reaches from the mean of the branch's last orbit: an orbit around one encloses
/// it, so it counts if it is no farther from the mean than the orbit's rms amplitude. It is one of the survey's if
/// Newton's method from the scene's grid comes to the same point (starts::is_same_fixed_point). Where a parameter moves
/// it is looked for at the last orbit's value of it, which the text tells unless the survey has one in the same place.
[[nodiscard]] EquilibriumEnd equilibrium_end(const scene::Scene& scene, const systems::System& system,
                                             const loop::Loop& last);

}  // namespace orbweaver::survey
