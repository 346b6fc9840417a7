#pragma once

#include <limits>
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

struct HopfPoints {
  std::vector<LocatedHopf> found;
  /// Of a pair whose real part is rounding's at both nodes and between them, the period: it passes nothing, for
  /// something holds it on the axis. NaN without one.
  double stays = std::numeric_limits<double>::quiet_NaN();
  bool is_undecided = false;  ///< whether eigenvalues pass the axis, rounding does not tell
};

/// Hopf points between two nodes of a curve of equilibria, along it; those at one place by their periods, the longest
/// first. At an end of the curve also where rounding has the eigenvalue on either side.
[[nodiscard]] HopfPoints hopf_points(const CurveEquations& curve, const CurveNode& a, const CurveNode& b, CurveEnds at);

}  // namespace orbweaver::starts
