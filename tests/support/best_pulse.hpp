#pragma once

#include <cmath>

#include "orbweaver/loop/grid/time_map_fit.hpp"

namespace orbweaver::test {

/// The pulse, kappa = 2^(j/4) between 1/32 and 32, that needs the fewest harmonics: what other maps are compared with.
inline loop::TimeMapFit best_pulse(const loop::Loop& loop, double tolerance) {
  loop::TimeMapFit best{{}, loop.cutoff + 1};
  for (int j = -20; j <= 20; ++j) {
    const loop::TimeMap map{std::pow(2.0, 0.25 * j), {}};
    const int harmonics = loop::harmonics_above(loop::with_time_map(loop, map, loop.cutoff), tolerance);
    if (harmonics < best.harmonics) best = {map, harmonics};
  }
  return best;
}

}  // namespace orbweaver::test
