#pragma once

#include <vector>

#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::bifurcation {

/// The families of small oscillations that a sweep with loops of `cutoff` harmonics found, longest period first: its
/// simple modes, and the directions in the kernels that several oscillations share.
[[nodiscard]] std::vector<starts::NormalMode> small_oscillations(const systems::System& system,
                                                                 const starts::SweepResult& sweep, int cutoff);

}  // namespace orbweaver::bifurcation
