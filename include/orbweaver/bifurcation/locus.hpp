#pragma once

#include <memory>
#include <string>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/locus_curve.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// What vanishes along the locus of an event, on the surface of orbits of `surface`, whose last free parameter is the
/// second one: of a sector the index's deviation (`index_deviation`), of a torus its test function, of a fold the
/// changes of what folds and of the second parameter. What it refers to must outlive it.
[[nodiscard]] continuation::LocusTest locus_test(const systems::System& surface, const loop::Isotropy& isotropy,
                                                 const Event& event, core::Team* team = nullptr);

}  // namespace orbweaver::bifurcation
