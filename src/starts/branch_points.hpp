#pragma once

#include <vector>

#include <Eigen/Core>

#include "curve_equations.hpp"

namespace orbweaver::starts {

/// Where other curves of equilibria pass through a step of a curve.
struct BranchPoints {
  std::vector<Eigen::VectorXd> places;  ///< along the step; those at one place once
  bool is_undecided = false;            ///< what rounding, or steps that do not converge, leaves open there
};

/// Of the steps from each node to the next, in their order. A node that is such a place counts to the step before it,
/// the first one to the step behind.
[[nodiscard]] std::vector<BranchPoints> branch_points(const CurveEquations& curve, const std::vector<CurveNode>& nodes);

}  // namespace orbweaver::starts
