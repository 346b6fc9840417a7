#include "orbweaver/numerics/lagrange.hpp"

#include <cstddef>

namespace orbweaver::numerics {

LagrangeWeights lagrange_weights(std::span<const double> nodes, double position) {
  LagrangeWeights out{std::vector<double>(nodes.size(), 1.0), std::vector<double>(nodes.size(), 0.0)};
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t l = 0; l < nodes.size(); ++l) {
      if (l == i) continue;
      const double gap = nodes[i] - nodes[l];
      const double distance = position - nodes[l];
      out.slope[i] = (out.slope[i] * distance + out.value[i]) / gap;
      out.value[i] *= distance / gap;
    }
  return out;
}

}  // namespace orbweaver::numerics
