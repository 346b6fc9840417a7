#pragma once

#include <optional>

#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Where the branch meets a family with more symmetry between two of its orbits, if it does. Beyond that point lie the
/// images of the orbits before it, or, where the broken part is not turned by the symmetry, the other side of a
/// crossing.
[[nodiscard]] std::optional<ArrivalRecord> arrival_between(
    const systems::System& system, continuation::FamilyCurve& family, const bifurcation::SymmetryWatch& watch,
    const continuation::Orbit& from, const bifurcation::SymmetryWatch::SampledOrbit& from_sampled,
    const continuation::Orbit& to, const bifurcation::SymmetryWatch::SampledOrbit& to_sampled);

/// A loop with few harmonics and s even in time, for comparisons.
[[nodiscard]] loop::Loop sketch_of(const loop::Loop& loop, int cutoff = 60);

}  // namespace orbweaver::survey
