#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// psi of a local minimum under whatever time maps, from `shift` by Gauss and Newton's method on the nodes of x, which
/// resolve what passes fast there: of a jump that takes 1e-6 of the period harmonics in time show nothing. To what the
/// distance at the minimum shows of it.
[[nodiscard]] double mapped_shift_near(const Loop& y, const Loop& x, const std::vector<int>& angles, double shift);

}  // namespace orbweaver::loop
