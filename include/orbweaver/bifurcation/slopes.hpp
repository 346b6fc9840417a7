#pragma once

#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// dT/ds, dE/ds and dp/ds of the family at a point, s being the length in modes and scalars, p the first parameter that
/// moves.
[[nodiscard]] double period_slope(const continuation::CurvePoint& point);
[[nodiscard]] double parameter_slope(const continuation::CurvePoint& point);
[[nodiscard]] double energy_slope(const systems::System& system, const continuation::CurvePoint& point);
/// Of the level (continuation::level_of): the energy, or the parameter that moves.
[[nodiscard]] double level_slope(const systems::System& system, const continuation::CurvePoint& point);

}  // namespace orbweaver::bifurcation
