#include "under_map.hpp"

#include <algorithm>

namespace orbweaver::continuation {

namespace {

/// Of a loop's harmonics, under another time map: one that needs more is better solved anew. Not measured.
constexpr int most_harmonics = 4;

}  // namespace

loop::Loop under_map(const loop::Loop& loop, const loop::TimeMap& map) {
  if (loop.time_map == map) return loop;
  const double allowed = std::max(loop::negligible_harmonic, 2.0 * loop::tail(loop));
  int k = loop.cutoff;
  loop::Loop out = loop::with_time_map(loop, map, k);
  while (loop::tail(out) > allowed && k < most_harmonics * loop.cutoff) {
    k = loop::next_cutoff(loop::allowed_cutoff_at_least(k));
    out = loop::with_time_map(loop, map, k);
  }
  return out;
}

}  // namespace orbweaver::continuation
