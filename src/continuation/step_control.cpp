#include "step_control.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::continuation {

namespace {

/// A step shrinks and grows by no more than this: errors of a polynomial that meets a bend overrate the bend, errors by
/// chance near zero say nothing. With degree 4 the factor 1.6 is reached at a tenth of the wanted error. Not measured.
constexpr double least_factor = 0.3;
constexpr double largest_factor = 1.6;
/// Keeps the quotient finite: rounding of a coordinate.
constexpr double least_error = 1e-16;

}  // namespace

double next_step_length(double length, double error, double wanted, int order) {
  const double ratio = wanted / std::max(error, least_error);
  const double factor = std::clamp(std::pow(ratio, 1.0 / (order + 1)), least_factor, largest_factor);
  return length * factor;
}

}  // namespace orbweaver::continuation
