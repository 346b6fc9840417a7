#pragma once

#include <vector>

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

/// The directions that symmetries single out, which are exact, in their order; and the unit vectors of their lines.
struct SymmetricDirections {
  std::vector<Direction> found;
  std::vector<Eigen::VectorXd> lines;
};

/// One of each set of images: along the lines that a subgroup fixes, and about an equilibrium the oscillations that
/// equivariances alone single out.
[[nodiscard]] SymmetricDirections symmetric_directions(const systems::System& system, const KernelActions& group,
                                                       const loop::Loop& base, const DirectionOptions& options);

}  // namespace orbweaver::bifurcation
