#pragma once

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

/// What base and direction have in common: the isotropy of the orbits born along it.
[[nodiscard]] loop::Isotropy isotropy_along(const systems::Structure& system, const KernelActions& group,
                                            const loop::Loop& base, const loop::Tangent& along,
                                            const DirectionOptions& options);

/// Whether no symmetry maps the unit kernel vector to its negative: both its sides lead to orbits of their own.
[[nodiscard]] bool has_other_sides(const KernelActions& group, const Eigen::VectorXd& v);

/// What an equilibrium's direction has besides: images and repetitions.
[[nodiscard]] Direction counted(const KernelActions& group, const Eigen::VectorXd& v, Direction direction);

/// A unit vector of the kernel, and `along` times as far along the base's own family (empty: none); of length 1.
[[nodiscard]] loop::Tangent leaving_along(loop::Tangent in_kernel, double along, const loop::Tangent& family);

}  // namespace orbweaver::bifurcation
