#pragma once

#include <string_view>
#include <vector>

#include "orbweaver/starts/equilibrium_curve.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/sweep_work.hpp"

namespace orbweaver::survey {

/// How the note of a point begins where something is not told.
inline constexpr std::string_view undecided_note = "undecided: ";

/// Whether one of a curve's points has such a note.
[[nodiscard]] bool is_undecided(const std::vector<EquilibriumPlace>& places);

/// The equilibrium with the system's own parameters. Of a driven system all coordinates but the phase rest, and the
/// phase's eigenvalue, 0, says nothing of its stability.
[[nodiscard]] EquilibriumPlace equilibrium_place(const systems::System& system, const std::vector<double>& point,
                                                 starts::LinearModes modes);

/// All points of a curve of equilibria, with their linear modes. A pair whose real part is 0 is one of the periods,
/// whether or not anything holds it there. At a Hopf point the pair that passes the axis counts
/// as imaginary, at a fold the least real eigenvalue as 0.
[[nodiscard]] std::vector<EquilibriumPlace> places_on(const systems::System& system,
                                                      const starts::EquilibriumCurve& curve);

}  // namespace orbweaver::survey
