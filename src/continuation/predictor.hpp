#pragma once

#include <span>
#include <vector>

#include "orbweaver/continuation/frontier.hpp"

namespace orbweaver::continuation {

/// A predicted point of a branch and the direction in which the branch passes it.
struct Prediction {
  std::vector<double> values;
  std::vector<double> tangent;
  int order = 0;  ///< degree of the polynomial that it lies on
  /// On a surface of orbits: a second direction, along which the correction goes as little as along `tangent`. Empty on
  /// a family.
  std::vector<double> across{};
};

/// The polynomial of degree `order` or less through the last points (Lagrange's form), with its derivative, at
/// `parameter`. Needs at least two points.
[[nodiscard]] Prediction extrapolate(std::span<const TracePoint> points, int order, double parameter);

}  // namespace orbweaver::continuation
