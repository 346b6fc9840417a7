#pragma once

#include <vector>

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

/// The directions in which orbits are found near the base, besides those along `lines` (unit vectors) and their images.
/// Throws NumericalError where there are neither lines nor isolated orbits, UndecidedError where rounding decides.
[[nodiscard]] Directions searched_directions(const systems::System& system, const KernelActions& group,
                                             const loop::Loop& base, const std::vector<Eigen::VectorXd>& lines,
                                             const DirectionOptions& options);

}  // namespace orbweaver::bifurcation
