#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// The name of the `mode`-th family of small oscillations around `point`, of all that there are, longest period first:
/// the scene's, if it names the equilibrium (angles modulo 2 pi), else "Equilibrium 2, mode 1".
[[nodiscard]] std::string base_family_name(const scene::Scene& scene, const systems::System& system,
                                           const std::vector<double>& point, int index, int mode);

/// "Equilibrium 2" for the second.
[[nodiscard]] std::string equilibrium_name(int index);

/// How many families the scene names at `point`.
[[nodiscard]] std::size_t names_given(const scene::Scene& scene, const systems::System& system,
                                      const std::vector<double>& point);

/// Throws InputError for names of a place at which no equilibrium lies, `equilibria` being those that are known: they
/// are of another system, or of other parameters.
void require_named(const scene::Scene& scene, const systems::System& system,
                   const std::vector<std::vector<double>>& equilibria);

/// The text, cut to what the archive's text columns hold (4096 bytes) with room to spare.
[[nodiscard]] std::string limited(std::string text);

/// "th1 = 0 deg, th2 = 180 deg, ...": an equilibrium for people. Of more than four coordinates those that are not 0.
[[nodiscard]] std::string point_text(const systems::System& system, const std::vector<double>& point);

}  // namespace orbweaver::survey
