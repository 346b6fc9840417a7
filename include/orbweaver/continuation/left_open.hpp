#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// How far across its family rounding of the equations may move an orbit with this isotropy: by the equations on its
/// own fundamental domain, linearised there, with residuals as large as rounding leaves them (a length as of
/// `arclength_between`). Where neighbours are nearer they are not told apart. 0 where that is not known: collocation
/// does not apply, has too many unknowns to factor its Jacobian (equations::exact_unknowns), or the field fails.
[[nodiscard]] double left_open_by_rounding(const systems::System& system, const loop::Loop& orbit,
                                           const loop::Isotropy& isotropy);

}  // namespace orbweaver::continuation
