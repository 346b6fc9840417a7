#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// `loop` at the times of the equidistant nodes s_j of `target`, j = first, first + stride, ... below `nodes`, less n
/// s_j: dimension x as many, component-major.
[[nodiscard]] std::vector<double> resampled(const Loop& loop, const TimeMap& target, int nodes, int first = 0,
                                            int stride = 1);

}  // namespace orbweaver::loop
