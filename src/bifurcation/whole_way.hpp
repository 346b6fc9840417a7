#pragma once

#include <optional>

#include "orbweaver/bifurcation/directions.hpp"

namespace orbweaver::bifurcation {

/// From the base to an orbit found, T with it, and to the one on the other side where that was found: base, tangent,
/// opposite and amplitude of a direction.
[[nodiscard]] Direction whole_way(const loop::Loop& base, const loop::Loop& orbit,
                                  const std::optional<loop::Loop>& opposite = {});

}  // namespace orbweaver::bifurcation
