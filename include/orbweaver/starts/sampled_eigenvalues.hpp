#pragma once

#include <span>
#include <vector>

#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::starts {

/// Which loops around a fixed point are asked: all, or those that are opposite to themselves half a period later about
/// it (the odd harmonics), of which none goes twice around another.
enum class Harmonics { all, odd };

/// The table of `sweep` alone: the smallest eigenvalue of the Hessian of the constant loop over these loops, against
/// its period. Throws as `sweep`.
[[nodiscard]] std::vector<SweepPoint> sampled_eigenvalues(const systems::System& system,
                                                          std::span<const double> fixed_point,
                                                          const SweepOptions& range, Harmonics harmonics);

}  // namespace orbweaver::starts
