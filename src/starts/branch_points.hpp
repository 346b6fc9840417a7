#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "curve_equations.hpp"

namespace orbweaver::starts {

/// The sign of the determinant of the equation bordered by the curve's direction; 0 where rounding has it.
[[nodiscard]] int sign_of_determinant(const CurveEquations& curve, const CurveNode& node);

/// Where another curve of equilibria passes through, between node n - 1 and node n, which may be such a place itself;
/// `signs`: of the determinant at all nodes. `folds`: the parameter turns between them.
[[nodiscard]] std::optional<Eigen::VectorXd> branch_point_before(const CurveEquations& curve,
                                                                 const std::vector<CurveNode>& nodes,
                                                                 const std::vector<int>& signs, std::size_t n,
                                                                 bool folds);

}  // namespace orbweaver::starts
