#pragma once

#include <Eigen/Dense>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// Step of the differences below, in parts of the coordinates' scales.
inline constexpr double difference_step = 0x1p-10;

/// Second derivatives of conserved quantity k (dimension x dimension), by central differences of its gradient with a
/// step for each coordinate.
[[nodiscard]] Eigen::MatrixXd second_derivatives(const systems::System& system, int k, const Eigen::VectorXd& point,
                                                 const Eigen::VectorXd& steps);

}  // namespace orbweaver::starts
