#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/scales.hpp"

namespace orbweaver::loop {

/// The loop in the units of a system's parameters, from one told in `scales`. Exact where these are powers of two.
[[nodiscard]] Loop in_units(Loop loop, const systems::Scales& scales);

/// The other way.
[[nodiscard]] Loop in_scales(Loop loop, const systems::Scales& scales);

}  // namespace orbweaver::loop
