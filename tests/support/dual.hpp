#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace orbweaver::ad {

/// A value with its derivatives in D variables (forward automatic differentiation). S is double, Lanes, or a Dual
/// again, for second derivatives.
template <class S, int D>
struct Dual {
  static constexpr auto size = static_cast<std::size_t>(D);

  S value;
  std::array<S, size> derivatives;

  Dual() = default;
  // Member by member: as a block of memory a Dual would not stay in registers.
  Dual(const Dual& other) : value(other.value) {
    for (std::size_t l = 0; l < size; ++l) derivatives[l] = other.derivatives[l];
  }
  Dual& operator=(const Dual& other) {
    value = other.value;
    for (std::size_t l = 0; l < size; ++l) derivatives[l] = other.derivatives[l];
    return *this;
  }
  /// A constant.
  Dual(double constant) : value(constant) {
    for (S& d : derivatives) d = S(0.0);
  }
  /// The variable number l, at `at`.
  static Dual variable(const S& at, int l) {
    Dual result(0.0);
    result.value = at;
    result.derivatives[static_cast<std::size_t>(l)] = S(1.0);
    return result;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  Dual& operator+=(double b) { return *this = *this + b; }
  Dual& operator-=(double b) { return *this = *this - b; }
  Dual& operator*=(double b) { return *this = *this * b; }
  Dual& operator/=(double b) { return *this = *this / b; }

  friend Dual operator-(const Dual& a) {
    return a.with(-a.value, [&](std::size_t l) { return -a.derivatives[l]; });
  }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return a.with(a.value + b.value, [&](std::size_t l) { return a.derivatives[l] + b.derivatives[l]; });
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return a.with(a.value - b.value, [&](std::size_t l) { return a.derivatives[l] - b.derivatives[l]; });
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return a.with(a.value * b.value,
                  [&](std::size_t l) { return a.derivatives[l] * b.value + a.value * b.derivatives[l]; });
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const S inverse = 1.0 / b.value;
    const S ratio = a.value / b.value;
    return a.with(ratio, [&](std::size_t l) { return (a.derivatives[l] - ratio * b.derivatives[l]) * inverse; });
  }
  friend Dual operator+(const Dual& a, double b) { return a.chain(a.value + b); }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(const Dual& a, double b) { return a.chain(a.value - b); }
  friend Dual operator-(double a, const Dual& b) { return -b + a; }
  friend Dual operator*(const Dual& a, double b) {
    return a.with(a.value * b, [&](std::size_t l) { return a.derivatives[l] * b; });
  }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) {
    const S inverse = S(1.0) / b;
    return a.with(a.value * inverse, [&](std::size_t l) { return a.derivatives[l] * inverse; });
  }
  friend Dual operator/(double a, const Dual& b) {
    const S ratio = a / b.value;
    return b.chain(ratio, -ratio / b.value);
  }

  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const S root = sqrt(x.value);
    return x.chain(root, 0.5 / root);
  }
  friend Dual exp(const Dual& x) {
    using std::exp;
    const S value = exp(x.value);
    return x.chain(value, value);
  }
  friend Dual log(const Dual& x) {
    using std::log;
    return x.chain(log(x.value), 1.0 / x.value);
  }
  friend Dual sin(const Dual& x) {
    using std::cos;
    using std::sin;
    return x.chain(sin(x.value), cos(x.value));
  }
  friend Dual cos(const Dual& x) {
    using std::cos;
    using std::sin;
    return x.chain(cos(x.value), -sin(x.value));
  }
  friend Dual tan(const Dual& x) {
    using std::tan;
    const S value = tan(x.value);
    return x.chain(value, 1.0 + value * value);
  }
  friend Dual asin(const Dual& x) {
    using std::asin;
    using std::sqrt;
    return x.chain(asin(x.value), 1.0 / sqrt(1.0 - x.value * x.value));
  }
  friend Dual acos(const Dual& x) {
    using std::acos;
    using std::sqrt;
    return x.chain(acos(x.value), -1.0 / sqrt(1.0 - x.value * x.value));
  }
  friend Dual atan(const Dual& x) {
    using std::atan;
    return x.chain(atan(x.value), 1.0 / (1.0 + x.value * x.value));
  }
  friend Dual sinh(const Dual& x) {
    using std::cosh;
    using std::sinh;
    return x.chain(sinh(x.value), cosh(x.value));
  }
  friend Dual cosh(const Dual& x) {
    using std::cosh;
    using std::sinh;
    return x.chain(cosh(x.value), sinh(x.value));
  }
  friend Dual tanh(const Dual& x) {
    using std::tanh;
    const S value = tanh(x.value);
    return x.chain(value, 1.0 - value * value);
  }
  friend Dual pow(const Dual& x, double exponent) {
    using std::pow;
    if (exponent == 0.0) return Dual(1.0);
    return x.chain(pow(x.value, exponent), pow(x.value, exponent - 1.0) * exponent);
  }

 private:
  template <class Derivative>
  [[nodiscard]] Dual with(const S& new_value, const Derivative& derivative) const {
    Dual result;
    result.value = new_value;
    for (std::size_t l = 0; l < size; ++l) result.derivatives[l] = derivative(l);
    return result;
  }
  /// A function of this: its value, and its slope times the derivatives.
  [[nodiscard]] Dual chain(const S& new_value, const S& slope) const {
    return with(new_value, [&](std::size_t l) { return derivatives[l] * slope; });
  }
  [[nodiscard]] Dual chain(const S& new_value) const {
    return with(new_value, [&](std::size_t l) { return derivatives[l]; });
  }
};

}  // namespace orbweaver::ad
