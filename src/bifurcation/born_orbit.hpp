#pragma once

#include <vector>

#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// The orbit at base + amplitude * along + u, u orthogonal to `along` and to the time shift: never the base's own
/// family, which is orthogonal to it too. More harmonics are taken where the orbit needs them.
[[nodiscard]] corrector::Result born_orbit(const systems::System& system, const loop::Loop& base,
                                           const loop::Tangent& along, const loop::Isotropy& isotropy, double amplitude,
                                           const corrector::Options& options = {});

/// The orbit at guess + u with u orthogonal to `held` (the modes of each) and to the time shift, solved for T and
/// `scalars` too.
[[nodiscard]] corrector::Result held_orbit(const systems::System& system, const loop::Loop& guess,
                                           const std::vector<loop::Tangent>& held, std::vector<loss::Scalar> scalars,
                                           const loop::Isotropy& isotropy, const corrector::Options& options = {});

}  // namespace orbweaver::bifurcation
