#pragma once

#include <span>
#include <vector>

namespace orbweaver::loop {

/// Trigonometric sums at any parameters s: modes ((2 cutoff + 1) x dimension, rows a_0, a_1, b_1, ...) to dimension x
/// s.size() values, component-major. Right to some eps times the largest harmonics; few of them, or few parameters, are
/// added one by one, others by a transform (docs/mathematics.md, "Time map").
[[nodiscard]] std::vector<double> scattered_sums(int cutoff, int dimension, const double* modes,
                                                 std::span<const double> s);

}  // namespace orbweaver::loop
