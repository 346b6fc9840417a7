#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "curve_equations.hpp"

namespace orbweaver::starts {

/// The place on the curve, and what begins there.
using LocatedHopf = std::pair<Eigen::VectorXd, HopfPoint>;

/// Which of two nodes are the curve's ends.
struct CurveEnds {
  bool first = false;
  bool last = false;
};

/// Hopf points between two nodes of a curve of equilibria, along it; those at one place by their periods, the longest
/// first. At an end of the curve also where rounding has the eigenvalue on either side.
[[nodiscard]] std::vector<LocatedHopf> hopf_points(const CurveEquations& curve, const CurveNode& a, const CurveNode& b,
                                                   CurveEnds at);

}  // namespace orbweaver::starts
