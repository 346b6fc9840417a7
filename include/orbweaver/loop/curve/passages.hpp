#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// Times in [0, T), in ascending order, at which coordinate `coordinate` passes `value`, in either direction; an angle
/// (`is_angle`, radians) passes it modulo 2 pi. Right to the rounding of the coordinate over its speed. What touches
/// the value without passing it does not count, nor does a coordinate that rests at it to 1e-12 of the loop's
/// amplitude. Pairs of passages nearer than an eighth of the highest harmonic's wave are found by the extremum between
/// them. Throws MisuseError for a coordinate that the loop does not have. Cost O(passages x cutoff + cutoff log
/// cutoff).
[[nodiscard]] std::vector<double> passages(const Loop& loop, int coordinate, double value, bool is_angle);

}  // namespace orbweaver::loop
