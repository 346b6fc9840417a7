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
constexpr double most_halvings = 3.0;

/// By which a step had to be longer for its error to be what is wanted.
double factor_to(double wanted, double error, int order) {
  return std::pow(wanted / std::max(error, least_error), 1.0 / (order + 1));
}

}  // namespace

double next_step_length(double length, double error, double wanted, int order) {
  return length * std::clamp(factor_to(wanted, error, order), least_factor, largest_factor);
}

int halvings_of_step(double error, double wanted, int order) {
  return static_cast<int>(std::lround(std::clamp(-std::log2(factor_to(wanted, error, order)), 0.0, most_halvings)));
}

}  // namespace orbweaver::continuation
