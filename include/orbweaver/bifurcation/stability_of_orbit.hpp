#pragma once

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// The multipliers of an orbit, whose error bounds have what rounding leaves open of the orbit itself: near an index of
/// 2 orbits are hardly isolated, and that is more than the bounds of spectrum::floquet, which are those of the loop.
/// `team` divides the work; may be null. Throws NumericalError as floquet does.
[[nodiscard]] spectrum::Stability stability_of(const systems::System& system, const loop::Loop& orbit,
                                               const loop::Isotropy& isotropy, core::Team* team = nullptr);

}  // namespace orbweaver::bifurcation
