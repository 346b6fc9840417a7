#pragma once

#include <vector>

#include "orbweaver/continuation/sweep.hpp"

namespace orbweaver::survey {

/// The families of small oscillations that a sweep with loops of `cutoff` harmonics found, longest period first: its
/// simple modes, and the directions in the kernels that several oscillations share.
[[nodiscard]] std::vector<continuation::NormalMode> small_oscillations(const systems::System& system,
                                                                       const continuation::SweepResult& sweep,
                                                                       int cutoff);

}  // namespace orbweaver::survey
