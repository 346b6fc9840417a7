#pragma once

#include <string>
#include <utility>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// From the last known orbit before the event to the first behind it.
[[nodiscard]] std::pair<double, double> between_known(const LocateWork& work, const continuation::FamilyCurve& family);

/// Why rounding hides an event that was not located for this `reason`: its function has no sign on the way to it, one
/// of the orbits on both sides is not told from others, or an index passes too steeply. Empty where none is so.
[[nodiscard]] std::string hidden_by_rounding(const systems::System& system, const LocateWork& work,
                                             const continuation::FamilyCurve& family,
                                             bifurcation::NotLocated::Reason reason, core::Team* team);

}  // namespace orbweaver::survey
