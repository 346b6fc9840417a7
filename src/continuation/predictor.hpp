#pragma once

#include <span>
#include <vector>

#include "orbweaver/continuation/branch.hpp"

namespace orbweaver::continuation {

/// The polynomial through the last points of a branch (Lagrange's form), with its derivative.
struct Prediction {
  std::vector<double> values;
  std::vector<double> tangent;  ///< derivative with respect to the parameter
  int order = 0;                ///< degree of the polynomial
};

/// The polynomial of degree `order` or less through the last points, at `parameter`. Needs at least two points.
[[nodiscard]] Prediction extrapolate(std::span<const TracePoint> points, int order, double parameter);

}  // namespace orbweaver::continuation
