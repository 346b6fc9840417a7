#pragma once

#include "plot/figure.hpp"

namespace orbweaver::report {

// Pictures of families as curves (docs/plots.md). Throw InputError where the archive has not what they show.
[[nodiscard]] Figure tree_figure(const archive::Archive& atlas, const PlotRequest& request);
[[nodiscard]] Figure energy_period_figure(const archive::Archive& atlas, const PlotRequest& request);
[[nodiscard]] Figure stability_figure(const archive::Archive& atlas, const PlotRequest& request);
/// Of one family also once gone around twice, which is computed anew.
[[nodiscard]] Figure off_branch_figure(const archive::Archive& atlas, const PlotRequest& request);
/// Of one family: the loss, and the gaps that the independent integrator leaves.
[[nodiscard]] Figure accuracy_figure(const archive::Archive& atlas, const PlotRequest& request);

}  // namespace orbweaver::report
