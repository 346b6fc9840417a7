#pragma once

#include "kernel_actions.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::bifurcation {

/// Whether `a` is further along at s = 0: its first coordinate there that differs by more than `tolerance` is larger.
[[nodiscard]] bool starts_further(const loop::Loop& a, const loop::Loop& b, double tolerance);

/// The one of the images of an orbit about an equilibrium, each started where the first reversor that it has has phase
/// 0 and in its standard phase, that starts furthest: a search finds any of them.
[[nodiscard]] loop::Loop standard_image(const systems::Structure& system, const KernelActions& group,
                                        const loop::Loop& orbit, double tolerance);

}  // namespace orbweaver::bifurcation
