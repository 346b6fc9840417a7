#include "step_control.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::continuation {

double next_step_length(double length, double error, double wanted, int order) {
  const double ratio = wanted / std::max(error, 1e-16);
  const double factor = std::clamp(std::pow(ratio, 1.0 / (order + 1)), 0.3, 1.6);
  return length * factor;
}

}  // namespace orbweaver::continuation
