#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace orbweaver::model {

/// A double, and to first order how far rounding may have brought it from what exact arithmetic would have made of the
/// same inputs (running error analysis: Higham 2002, Accuracy and Stability of Numerical Algorithms, section 3.3,
/// doi:10.1137/1.9780898718027): half a unit in the last place an operation, one of a function. What is written for any
/// scalar, as the conserved quantities of a system (systems/formulas.hpp), says by it how many digits it loses where
/// terms cancel.
class Rounded {
 public:
  Rounded() = default;
  Rounded(double exact) : _value(exact) {}

  [[nodiscard]] double value() const { return _value; }
  [[nodiscard]] double error() const { return _error; }

  friend Rounded operator+(Rounded a, Rounded b) { return operation(a._value + b._value, a._error + b._error); }
  friend Rounded operator-(Rounded a, Rounded b) { return operation(a._value - b._value, a._error + b._error); }
  friend Rounded operator*(Rounded a, Rounded b) {
    return operation(a._value * b._value, std::abs(a._value) * b._error + std::abs(b._value) * a._error);
  }
  friend Rounded operator/(Rounded a, Rounded b) {
    const double quotient = a._value / b._value;
    return operation(quotient, (a._error + std::abs(quotient) * b._error) / std::abs(b._value));
  }
  friend Rounded operator-(Rounded a) { return {-a._value, a._error}; }
  friend Rounded sqrt(Rounded x) {
    const double root = std::sqrt(x._value);
    return operation(root, 0.5 * x._error / root);
  }
  friend Rounded exp(Rounded x) { return function(std::exp(x._value), std::exp(x._value), x); }
  friend Rounded log(Rounded x) { return function(std::log(x._value), 1.0 / x._value, x); }
  friend Rounded sin(Rounded x) { return function(std::sin(x._value), std::cos(x._value), x); }
  friend Rounded cos(Rounded x) { return function(std::cos(x._value), std::sin(x._value), x); }
  friend Rounded asin(Rounded x) {
    return function(std::asin(x._value), 1.0 / std::sqrt((1.0 - x._value) * (1.0 + x._value)), x);
  }
  friend Rounded acos(Rounded x) {
    return function(std::acos(x._value), 1.0 / std::sqrt((1.0 - x._value) * (1.0 + x._value)), x);
  }
  friend Rounded atan(Rounded x) { return function(std::atan(x._value), 1.0 / (1.0 + x._value * x._value), x); }
  friend Rounded tanh(Rounded x) {
    const double tangent = std::tanh(x._value);
    return function(tangent, 1.0 - tangent * tangent, x);
  }
  friend Rounded erf(Rounded x) {
    return function(std::erf(x._value), 2.0 * std::numbers::inv_sqrtpi * std::exp(-x._value * x._value), x);
  }

 private:
  static constexpr double unit = std::numeric_limits<double>::epsilon();

  Rounded(double value, double error) : _value(value), _error(error) {}
  static Rounded operation(double value, double error) { return {value, error + 0.5 * unit * std::abs(value)}; }
  static Rounded function(double value, double derivative, Rounded x) {
    return {value, std::abs(derivative) * x._error + unit * std::abs(value)};
  }

  double _value = 0.0;
  double _error = 0.0;
};

}  // namespace orbweaver::model
