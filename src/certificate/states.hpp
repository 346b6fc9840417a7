#pragma once

#include <cmath>
#include <vector>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::certificate {

using State = std::vector<double>;
using States = std::vector<State>;

inline double norm(const State& state) {
  double sum = 0.0;
  for (const double value : state) sum += value * value;
  return std::sqrt(sum);
}

inline double distance(const State& a, const State& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

inline Eigen::VectorXd vector_of(const State& state) {
  return Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
}

}  // namespace orbweaver::certificate
