#pragma once

#include <optional>
#include <vector>

#include "orbweaver/continuation/frontier.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::continuation {

/// More cells for an orbit whose last harmonics exceed `tail_limit`, and if `fit_pulse` with a sharper pulse of the
/// time map where that needs clearly fewer harmonics; none where it would take more than `largest_cutoff`.
[[nodiscard]] std::optional<Resolution> finer_resolution(const equations::Collocation& equations,
                                                         const std::vector<double>& values, double tail_limit,
                                                         int largest_cutoff, bool fit_pulse);

/// A general time map (loop::fit_general) for a resolved orbit on many cells, with room above the harmonics that exceed
/// `tolerance` under it, and no more cells; none where it would not save a fifth of the harmonics.
[[nodiscard]] std::optional<Resolution> general_resolution(const equations::Collocation& equations,
                                                           const std::vector<double>& values,
                                                           const loop::Isotropy& isotropy, double tolerance,
                                                           int least_cutoff, double least_density);

/// Cells for an orbit whose needed harmonics fill less than two thirds of its own; none otherwise.
[[nodiscard]] std::optional<int> coarser_cells(const loop::Loop& loop, const loop::FundamentalDomain& domain,
                                               double tail_limit, int least_cutoff);

}  // namespace orbweaver::continuation
