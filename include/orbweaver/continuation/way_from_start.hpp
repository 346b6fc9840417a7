#pragma once

#include <algorithm>
#include <cmath>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::continuation {

/// Whether the family goes through the crossing where it is born: three times around the base, at one of order 3. It
/// may leave it along the base itself, and with any slope of T and E. At others it leaves along its direction.
[[nodiscard]] constexpr bool goes_through(int times) { return times == 3; }
[[nodiscard]] inline bool goes_through(const Start& start) { return goes_through(start.times); }

/// The way from a start to an orbit of the family, in time: cosines of the angle between it and the direction in which
/// the branch was to leave.
struct WayFromStart {
  double share = 0.0;  ///< of a family that goes through: of what does not repeat as the base does
  double share_of_whole = 0.0;

  /// What lies on the base's own family has next to none of the direction: from 84 degrees on it is told from that by
  /// rounding and curvature no more. Not measured.
  [[nodiscard]] bool is_along_base() const { return share_of_whole < 0.1; }
};

/// From `start.base`, which has the identity as its time map.
[[nodiscard]] inline WayFromStart way_from(const Start& start, const loop::Loop& orbit) {
  const int cutoff = std::min(start.base.cutoff, orbit.cutoff);
  const loop::Loop even = orbit.time_map.is_identity() ? orbit : loop::evenly_in_time(orbit);
  const loop::Loop there = loop::with_cutoff(even, cutoff);
  const loop::Loop base = loop::with_cutoff(start.base, cutoff);
  const auto width = static_cast<std::size_t>(base.dimension);
  double along = 0.0;
  double direction = 0.0;
  double whole = 0.0;
  double alone = 0.0;
  for (std::size_t n = 0; n < there.modes.size(); ++n) {
    const double step = there.modes[n] - base.modes[n];
    whole += step * step;
    const std::size_t harmonic = (n / width + 1) / 2;  // a_0, a_1, b_1, a_2, ...
    if (goes_through(start) && harmonic % static_cast<std::size_t>(start.times) == 0) continue;
    along += step * start.direction.modes[n];
    direction += start.direction.modes[n] * start.direction.modes[n];
    alone += step * step;
  }
  const auto cosine = [&](double square) { return along != 0.0 ? along / std::sqrt(direction * square) : 0.0; };
  return {cosine(alone), cosine(whole)};
}

}  // namespace orbweaver::continuation
