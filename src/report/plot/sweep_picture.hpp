#pragma once

#include "plot/figure.hpp"

namespace orbweaver::report {

/// The smallest eigenvalue of the Hessian at the equilibria of the archive's scene against the period: computed anew,
/// since archives do not hold it. With one family the equilibrium that it begins at, and the same over loops of odd
/// harmonics. Throws InputError where the scene leads to no equilibrium, or a family that is named begins at none.
[[nodiscard]] Figure sweep_figure(const archive::Archive& atlas, const PlotRequest& request);

}  // namespace orbweaver::report
