#pragma once

#include <vector>

#include <Eigen/Dense>

namespace orbweaver::bifurcation {

/// Elements of a finite group and their fixed spaces differ by 2 sin(angle/2) of a rotation, far more than this up to
/// orders of some hundred. Kernel vectors are good to 1e-4 or better (`DirectionOptions::kernel_tolerance`).
inline constexpr double same_element = 1e-2;

/// The fixed spaces of all groups that some of these orthogonal matrices (dimension x dimension) generate: orthonormal
/// bases, one a space, the whole space first, without the trivial one.
[[nodiscard]] std::vector<Eigen::MatrixXd> fixed_spaces(const std::vector<Eigen::MatrixXd>& matrices, int dimension);

}  // namespace orbweaver::bifurcation
