#pragma once

#include <functional>
#include <string>
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

/// "T = 13.962634, c1 = 0.425489022".
[[nodiscard]] std::string place_text(const systems::System& system, const loop::Loop& loop);

}  // namespace orbweaver::continuation
