#pragma once

#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// How fast s is to run for orbits of period `period` that pass near the zeros of the system's guards: in proportion to
/// `base` 2 pi/T + sum_k m_k (least g_k / g_k)^(3/2), m_k being one over the distance in complex time at which guard k,
/// expanded about its smallest value, is zero (docs/mathematics.md, "Time map"). The system must outlive it.
[[nodiscard]] loop::Rate guard_rate(const systems::System& system, double period, double base);

}  // namespace orbweaver::continuation
