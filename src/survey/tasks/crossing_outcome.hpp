#pragma once

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/locate_work.hpp"

namespace orbweaver::survey {

/// A zero of a test function that counts multipliers in a sector.
[[nodiscard]] bool is_in_sector(const bifurcation::Event& event);

/// All of an outcome that the located event itself says: not whose it is, nor where on its family, nor what leaves
/// there. `isotropy`: of the orbit there, at its present phase. Throws MisuseError for an event that the archive has no
/// kind of crossings for.
void describe(const systems::System& system, const bifurcation::Event& event, const bifurcation::Crossing& crossing,
              const loop::Isotropy& isotropy, LocateOutcome& outcome);

}  // namespace orbweaver::survey
