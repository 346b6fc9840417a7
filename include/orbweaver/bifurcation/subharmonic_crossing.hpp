#pragma once

#include <memory>
#include <optional>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

struct CrossingFound {
  Event event;
  Crossing crossing;
};

/// The crossing beneath a loop that goes nearly `multiplicity` times around an orbit, each time a little differently:
/// the orbit at which families leave that close after so many of its periods, in the sector of that order (of the whole
/// period's map) that is nearest to the multipliers there. Of orbits of nearly the amplitude of what repeats in `near`.
/// None where no such orbit is found, for instance where the family's amplitude has an extremum, and for systems that
/// are not symplectic or have more than one pair of multipliers.
[[nodiscard]] std::optional<CrossingFound> crossing_beneath(const std::shared_ptr<const systems::System>& system,
                                                            const loop::Loop& near, int multiplicity,
                                                            const continuation::Options& options);

}  // namespace orbweaver::bifurcation
