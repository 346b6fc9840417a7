#pragma once

#include <vector>

#include "plot/figure.hpp"

namespace orbweaver::report {

/// How a family begins, in configuration space: the orbit that it was born on, the perturbation, enlarged, and the
/// family's orbits. Throws InputError for a family that was born at no crossing.
[[nodiscard]] std::vector<Figure> birth_figures(const archive::Archive& atlas, const PlotRequest& request);

}  // namespace orbweaver::report
