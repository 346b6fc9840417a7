#include "step_control.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::continuation {

double next_step_length(double length, int iterations, double turning, double wanted_turning) {
  constexpr double wanted_iterations = 4.0;
  const double by_iterations = std::pow(2.0, (wanted_iterations - iterations) / 2.0);
  const double by_turning = wanted_turning / std::max(turning, 1e-12);
  return length * std::clamp(std::min(by_iterations, by_turning), 0.4, 2.0);
}

}  // namespace orbweaver::continuation
