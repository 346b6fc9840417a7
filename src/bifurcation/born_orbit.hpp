#pragma once

#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// The orbit at base + amplitude * along + u, u orthogonal to `along` and to the time shift: never the base's own
/// family, which is orthogonal to it too. More harmonics are taken where the orbit needs them.
[[nodiscard]] corrector::Result born_orbit(const systems::System& system, const loop::Loop& base,
                                           const loop::Tangent& along, const loop::Isotropy& isotropy, double amplitude,
                                           const corrector::Options& options = {});

}  // namespace orbweaver::bifurcation
