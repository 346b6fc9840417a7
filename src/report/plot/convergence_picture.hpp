#pragma once

#include "plot/figure.hpp"

namespace orbweaver::report {

/// How solvers come to an orbit of a family: the loss, and the gap after integrating once around, against iterations,
/// from one guess a step along the family away. By the paper's optimiser without and with its extrapolation, and by the
/// survey's own way. Computed anew. Throws InputError where the orbit has not two before it.
[[nodiscard]] Figure convergence_figure(const archive::Archive& atlas, const PlotRequest& request);

}  // namespace orbweaver::report
