#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/description.hpp"

namespace orbweaver::survey {

/// The name of the `mode`-th family (longest period first) of small oscillations around `point`: the scene's, if it
/// names the equilibrium (angles modulo 2 pi), else "Equilibrium 2, mode 1".
[[nodiscard]] std::string base_family_name(const scene::Scene& scene, const systems::Description& system,
                                           const std::vector<double>& point, int index, int mode);

/// The text, cut to what the archive's text columns hold (4096 bytes) with room to spare.
[[nodiscard]] std::string limited(std::string text);

/// "(0, 180)" in degrees for angles: an equilibrium for people.
[[nodiscard]] std::string point_text(const systems::Description& system, const std::vector<double>& point);

}  // namespace orbweaver::survey
