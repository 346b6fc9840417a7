#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::loop {

/// The orbit with s = 0 where the archive has it. `isotropy`: the loop's, at its present phase.
///
/// With a reversor in the group that `isotropy` generates: on the fixed set of the first one in the system's order, at
/// that of its two points where the first coordinate is largest (of equal ones the next; angles that wind are compared
/// modulo 2 pi). Otherwise at the maximum of the first angle, or of the first coordinate of a system without angles,
/// less the linear part if it winds.
[[nodiscard]] Loop in_standard_phase(const systems::Structure& system, const Loop& loop, const Isotropy& isotropy);

/// The orbit with s = 0 where the first reversor that it has to `tolerance`, at any phase, has phase 0; as it is where
/// it has none. An isotropy found there has that reversor.
[[nodiscard]] Loop at_first_reversor(const systems::Structure& system, const Loop& loop, double tolerance);

}  // namespace orbweaver::loop
