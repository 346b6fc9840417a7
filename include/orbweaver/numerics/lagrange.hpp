#pragma once

#include <span>
#include <vector>

namespace orbweaver::numerics {

/// What the values at some nodes count for the polynomial through them, one number a node.
struct LagrangeWeights {
  std::vector<double> value;
  std::vector<double> slope;  ///< of its derivative
};

/// The weights at `position` for nodes that differ. Exactly 1 and 0 at a node.
[[nodiscard]] LagrangeWeights lagrange_weights(std::span<const double> nodes, double position);

}  // namespace orbweaver::numerics
