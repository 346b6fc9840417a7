#pragma once

#include <optional>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// What rounding of the equations leaves open of an orbit.
struct LeftOpen {
  double across = 0.0;     ///< how far across its family it may be moved (a length as of `arclength_between`)
  double period = 0.0;     ///< by how much its period is moved there,
  double energy = 0.0;     ///< and its energy
  double parameter = 0.0;  ///< and the parameter that moves along its family
  std::optional<loop::Loop> beside{};  ///< the loop moved that way, as little as is seen; none where nothing is known
  double times = 0.0;                  ///< as far as from the loop to that it may be moved so often
};

/// By the equations of an orbit with this isotropy on its own fundamental domain, linearised there, with residuals as
/// large as rounding leaves them. Where neighbours are nearer than `across` they are not told apart. 0 where that is
/// not known: collocation does not apply, GMRES does not solve the linearised equations and they have too many unknowns
/// to be factored (equations::exact_unknowns), or the field fails.
[[nodiscard]] LeftOpen left_open_by_rounding(const systems::System& system, const loop::Loop& orbit,
                                             const loop::Isotropy& isotropy);

}  // namespace orbweaver::continuation
