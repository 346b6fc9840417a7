#pragma once

#include <vector>

#include "plot/figure.hpp"

namespace orbweaver::report {

// Pictures of orbits (docs/plots.md), panels side by side. Throw InputError where no family or a wrong step is named,
// and where the archive has not what they show.

/// Paths in configuration space: one orbit, or several along the family.
[[nodiscard]] std::vector<Figure> orbit_figures(const archive::Archive& atlas, const PlotRequest& request);
/// One orbit at equal times: rods and bobs of pendulums, else places on its path.
[[nodiscard]] std::vector<Figure> strobe_figures(const archive::Archive& atlas, const PlotRequest& request);
/// Moduli of the Fourier coefficients of one orbit.
[[nodiscard]] std::vector<Figure> spectrum_figures(const archive::Archive& atlas, const PlotRequest& request);
/// The points of the scene's Poincare section.
[[nodiscard]] std::vector<Figure> section_figures(const archive::Archive& atlas, const PlotRequest& request);

}  // namespace orbweaver::report
