#pragma once

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/systems/system.hpp"
#include "tree/base_families.hpp"

namespace orbweaver::survey {

/// Adds a row for every equilibrium of the sweeps and for every point of the curves that they lie on, in the units of
/// the scene. A curve that several lie on is the first one's. Of an equilibrium whose sweep failed only the place is
/// known.
void add_equilibria(const systems::System& system, const SweepsEnded& sweeps, archive::Records& tables);

}  // namespace orbweaver::survey
