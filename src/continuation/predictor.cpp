#include "predictor.hpp"

#include <algorithm>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::continuation {

Prediction extrapolate(std::span<const TracePoint> points, int order, double parameter) {
  core::require(points.size() >= 2, "a prediction needs two points");
  const std::size_t used = std::min(points.size(), static_cast<std::size_t>(order) + 1);
  const auto last = points.last(used);
  Prediction out;
  out.order = static_cast<int>(used) - 1;
  out.values.assign(last[0].values.size(), 0.0);
  out.tangent.assign(last[0].values.size(), 0.0);
  std::vector<double> parameters;
  for (const TracePoint& point : last) parameters.push_back(point.parameter);
  const numerics::LagrangeWeights weights = numerics::lagrange_weights(parameters, parameter);
  for (std::size_t i = 0; i < used; ++i) {
    const std::vector<double>& v = last[i].values;
    for (std::size_t n = 0; n < v.size(); ++n) {
      out.values[n] += weights.value[i] * v[n];
      out.tangent[n] += weights.slope[i] * v[n];
    }
  }
  return out;
}

}  // namespace orbweaver::continuation
