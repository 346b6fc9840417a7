#pragma once

#include "orbweaver/loop/symmetry/fundamental_domain.hpp"

/// The numbers of cells that are used on a fundamental domain: multiples of four with small factors, each about 1.2
/// times the one before, so that few grids are made and their transforms are fast.
namespace orbweaver::continuation::cell_counts {

/// The fewest that are used. Not measured.
inline constexpr int least = 8;
/// The highest harmonic on a grid of `cells`.
[[nodiscard]] int cutoff_of(const loop::FundamentalDomain& domain, int cells);
/// The smallest one whose grid has harmonics up to `cutoff`.
[[nodiscard]] int at_least_for_cutoff(const loop::FundamentalDomain& domain, int cutoff);
[[nodiscard]] int at_least(int cells);
[[nodiscard]] int next(int cells);
[[nodiscard]] int previous(int cells);

}  // namespace orbweaver::continuation::cell_counts
