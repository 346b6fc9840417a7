#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// `loop` at the times of the equidistant nodes s_j of `target`, less n s_j: dimension x nodes, component-major.
[[nodiscard]] std::vector<double> resampled(const Loop& loop, const TimeMap& target, int nodes);

}  // namespace orbweaver::loop
