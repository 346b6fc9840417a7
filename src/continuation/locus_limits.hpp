#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/continuation/locus_curve.hpp"

namespace orbweaver::continuation {

/// Where a locus ends: `off` vanishes there.
struct LocusLimit {
  Ending ending;
  std::function<double(const loop::Loop&)> off;
};

/// The finite ones of the options, then the boundaries of the test function. Valid as long as the three are.
[[nodiscard]] std::vector<LocusLimit> limits_of(const systems::System& system, const LocusOptions& options,
                                                const LocusTest& test);

/// The end at an equilibrium, or at orbits of more symmetry, between two neighbouring points, of which none is sought:
/// the surface is even in what breaks the symmetry, so that they are zeros of the test function as well. Its text has
/// the place, extrapolated from the points `before`; with it comes how far it is, in parts of the way to `to`.
[[nodiscard]] std::optional<std::pair<Ending, double>> arrival_between(const systems::System& system,
                                                                       const LocusTest& test,
                                                                       const std::vector<LocusPoint>& before,
                                                                       const loop::Loop& from, const loop::Loop& to);

/// "T = 13.962634, c1 = 0.425489022".
[[nodiscard]] std::string place_text(const systems::System& system, const loop::Loop& loop);

}  // namespace orbweaver::continuation
