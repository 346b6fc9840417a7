#pragma once

#include <vector>

#include <Eigen/Dense>

namespace orbweaver::bifurcation {

/// The fixed spaces of all groups that some of these orthogonal matrices (dimension x dimension) generate: orthonormal
/// bases, one a space, the whole space first, without the trivial one.
[[nodiscard]] std::vector<Eigen::MatrixXd> fixed_spaces(const std::vector<Eigen::MatrixXd>& matrices, int dimension);

}  // namespace orbweaver::bifurcation
