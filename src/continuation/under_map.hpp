#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/time_map.hpp"

namespace orbweaver::continuation {

/// The loop under another time map, with enough harmonics for it: up to four times its own.
[[nodiscard]] loop::Loop under_map(const loop::Loop& loop, const loop::TimeMap& map);

}  // namespace orbweaver::continuation
