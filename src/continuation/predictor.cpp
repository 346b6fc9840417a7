#include "predictor.hpp"

#include <algorithm>

#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {

Prediction extrapolate(std::span<const TracePoint> points, int order, double parameter) {
  core::require(points.size() >= 2, "a prediction needs two points");
  const std::size_t used = std::min(points.size(), static_cast<std::size_t>(order) + 1);
  const auto last = points.last(used);
  Prediction out;
  out.order = static_cast<int>(used) - 1;
  out.values.assign(last[0].values.size(), 0.0);
  out.tangent.assign(last[0].values.size(), 0.0);
  for (std::size_t i = 0; i < used; ++i) {
    double weight = 1.0;
    double slope = 0.0;
    for (std::size_t l = 0; l < used; ++l) {
      if (l == i) continue;
      const double gap = last[i].parameter - last[l].parameter;
      const double distance = parameter - last[l].parameter;
      slope = (slope * distance + weight) / gap;
      weight *= distance / gap;
    }
    const std::vector<double>& v = last[i].values;
    for (std::size_t n = 0; n < v.size(); ++n) {
      out.values[n] += weight * v[n];
      out.tangent[n] += slope * v[n];
    }
  }
  return out;
}

}  // namespace orbweaver::continuation
