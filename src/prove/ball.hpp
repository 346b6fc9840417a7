#pragma once

#include <string>
#include <vector>

#if __has_include(<arb.h>)
#include <acb.h>
#include <arb.h>
#include <arb_mat.h>
#else  // from version 3 of FLINT on
#include <flint/acb.h>
#include <flint/arb.h>
#include <flint/arb_mat.h>
#endif

#include "orbweaver/numerics/extended.hpp"

namespace orbweaver::prove {

/// While it lives, midpoints of this thread's balls are rounded to so many bits. They nest.
class WorkingBits {
 public:
  explicit WorkingBits(long bits);
  ~WorkingBits();
  WorkingBits(const WorkingBits&) = delete;
  WorkingBits& operator=(const WorkingBits&) = delete;
  [[nodiscard]] static long in_force();

 private:
  long _before;
};

/// A real number between two others, midpoint and radius (Arb): the result of an operation holds all results of that
/// operation on the numbers that its operands hold, roundings included. What is not defined on all of them (a root of
/// negative numbers, a quotient by 0) is not finite.
class Ball {
 public:
  Ball() { arb_init(_ball); }
  Ball(double exact) : Ball() { arb_set_d(_ball, exact); }
  Ball(const Ball& other) : Ball() { arb_set(_ball, other._ball); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(_ball, other._ball); }
  Ball& operator=(const Ball& other) {
    arb_set(_ball, other._ball);
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(_ball, other._ball);
    return *this;
  }
  ~Ball() { arb_clear(_ball); }

  /// What the decimal number is, and not the double next to it. Throws core::InputError for a text that is none.
  [[nodiscard]] static Ball of_decimal(const std::string& decimal);
  /// Exactly this number.
  [[nodiscard]] static Ball of(const numerics::Extended& exact);
  /// As `exact_text` wrote it. Throws core::InputError for a text that it did not.
  [[nodiscard]] static Ball of_exact_text(const std::string& text);
  [[nodiscard]] static Ball pi();
  /// [-radius, radius].
  [[nodiscard]] static Ball around_zero(const Ball& radius);

  arb_ptr get() { return _ball; }
  arb_srcptr get() const { return _ball; }

  [[nodiscard]] bool is_finite() const { return arb_is_finite(_ball) != 0; }
  [[nodiscard]] Ball middle() const;
  /// An upper bound of the radius, and of the modulus, exact.
  [[nodiscard]] Ball radius() const;
  [[nodiscard]] Ball modulus() const;
  [[nodiscard]] double middle_in_double() const;
  /// Rounded outwards.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  [[nodiscard]] bool contains(const Ball& other) const { return arb_contains(_ball, other._ball) != 0; }
  [[nodiscard]] bool overlaps(const Ball& other) const { return arb_overlaps(_ball, other._ball) != 0; }
  /// This one with the numbers that are at most `error` away.
  [[nodiscard]] Ball widened(const Ball& error) const;
  /// All digits of both numbers, to be read again by `of_exact_text`.
  [[nodiscard]] std::string exact_text() const;

  Ball& operator+=(const Ball& b);
  Ball& operator-=(const Ball& b);
  Ball& operator*=(const Ball& b);
  Ball& operator/=(const Ball& b);

 private:
  arb_t _ball;
};

[[nodiscard]] Ball operator+(Ball a, const Ball& b);
[[nodiscard]] Ball operator-(Ball a, const Ball& b);
[[nodiscard]] Ball operator*(Ball a, const Ball& b);
[[nodiscard]] Ball operator/(Ball a, const Ball& b);
[[nodiscard]] Ball operator-(Ball a);
/// Whether it holds for all numbers of both.
[[nodiscard]] bool operator<(const Ball& a, const Ball& b);
[[nodiscard]] bool operator<=(const Ball& a, const Ball& b);

[[nodiscard]] Ball sqrt(const Ball& x);
[[nodiscard]] Ball exp(const Ball& x);
[[nodiscard]] Ball log(const Ball& x);
[[nodiscard]] Ball sin(const Ball& x);
[[nodiscard]] Ball cos(const Ball& x);
[[nodiscard]] Ball asin(const Ball& x);
[[nodiscard]] Ball acos(const Ball& x);
[[nodiscard]] Ball atan(const Ball& x);
[[nodiscard]] Ball tanh(const Ball& x);
[[nodiscard]] Ball erf(const Ball& x);
[[nodiscard]] Ball pow(const Ball& x, const Ball& exponent);

using BallVector = std::vector<Ball>;

/// A complex number in a rectangle. Roots and logarithms are not finite where the rectangle meets the cut of
/// their branch: what is finite is analytic on all of the rectangle.
class ComplexBall {
 public:
  ComplexBall() { acb_init(_ball); }
  explicit ComplexBall(double exact) : ComplexBall() { acb_set_d(_ball, exact); }
  explicit ComplexBall(const Ball& real) : ComplexBall() { acb_set_arb(_ball, real.get()); }
  ComplexBall(const Ball& real, const Ball& imaginary) : ComplexBall() {
    acb_set_arb_arb(_ball, real.get(), imaginary.get());
  }
  ComplexBall(const ComplexBall& other) : ComplexBall() { acb_set(_ball, other._ball); }
  ComplexBall(ComplexBall&& other) noexcept : ComplexBall() { acb_swap(_ball, other._ball); }
  ComplexBall& operator=(const ComplexBall& other) {
    acb_set(_ball, other._ball);
    return *this;
  }
  ComplexBall& operator=(ComplexBall&& other) noexcept {
    acb_swap(_ball, other._ball);
    return *this;
  }
  ~ComplexBall() { acb_clear(_ball); }

  acb_ptr get() { return _ball; }
  acb_srcptr get() const { return _ball; }
  [[nodiscard]] bool is_finite() const { return acb_is_finite(_ball) != 0; }
  [[nodiscard]] Ball real() const;
  [[nodiscard]] Ball imaginary() const;
  /// An upper bound, exact.
  [[nodiscard]] Ball modulus() const;

 private:
  acb_t _ball;
};

[[nodiscard]] ComplexBall operator+(const ComplexBall& a, const ComplexBall& b);
[[nodiscard]] ComplexBall operator-(const ComplexBall& a, const ComplexBall& b);
[[nodiscard]] ComplexBall operator*(const ComplexBall& a, const ComplexBall& b);
[[nodiscard]] ComplexBall operator/(const ComplexBall& a, const ComplexBall& b);
[[nodiscard]] ComplexBall operator-(const ComplexBall& a);
[[nodiscard]] ComplexBall sqrt(const ComplexBall& x);
[[nodiscard]] ComplexBall exp(const ComplexBall& x);
[[nodiscard]] ComplexBall log(const ComplexBall& x);
[[nodiscard]] ComplexBall sin(const ComplexBall& x);
[[nodiscard]] ComplexBall cos(const ComplexBall& x);
[[nodiscard]] ComplexBall tanh(const ComplexBall& x);
[[nodiscard]] ComplexBall erf(const ComplexBall& x);
/// Not needed by any registered system, and not finite: Arb does not say where their branches are cut.
[[nodiscard]] ComplexBall asin(const ComplexBall& x);
[[nodiscard]] ComplexBall acos(const ComplexBall& x);
[[nodiscard]] ComplexBall atan(const ComplexBall& x);

/// A matrix of balls.
class BallMatrix {
 public:
  BallMatrix() : BallMatrix(0, 0) {}
  /// Of zeros.
  BallMatrix(std::size_t rows, std::size_t columns) {
    arb_mat_init(_matrix, static_cast<slong>(rows), static_cast<slong>(columns));
  }
  BallMatrix(const BallMatrix& other) : BallMatrix(other.rows(), other.columns()) {
    arb_mat_set(_matrix, other._matrix);
  }
  BallMatrix(BallMatrix&& other) noexcept : BallMatrix() { arb_mat_swap(_matrix, other._matrix); }
  BallMatrix& operator=(BallMatrix other) noexcept {
    arb_mat_swap(_matrix, other._matrix);
    return *this;
  }
  ~BallMatrix() { arb_mat_clear(_matrix); }
  [[nodiscard]] static BallMatrix identity(std::size_t size);
  /// One column.
  [[nodiscard]] static BallMatrix of(const BallVector& column);

  arb_mat_struct* get() { return _matrix; }
  const arb_mat_struct* get() const { return _matrix; }
  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(arb_mat_nrows(_matrix)); }
  [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(arb_mat_ncols(_matrix)); }
  [[nodiscard]] Ball at(std::size_t i, std::size_t j) const;
  void set(std::size_t i, std::size_t j, const Ball& value);
  [[nodiscard]] double middle_in_double(std::size_t i, std::size_t j) const;
  [[nodiscard]] BallVector column(std::size_t j) const;
  [[nodiscard]] BallMatrix block(std::size_t row, std::size_t column, std::size_t rows, std::size_t columns) const;
  void set_block(std::size_t row, std::size_t column, const BallMatrix& block);
  [[nodiscard]] bool is_finite() const { return arb_mat_is_finite(_matrix) != 0; }
  [[nodiscard]] BallMatrix middle() const;
  [[nodiscard]] Ball trace() const;

 private:
  arb_mat_t _matrix;
};

[[nodiscard]] BallMatrix operator+(const BallMatrix& a, const BallMatrix& b);
[[nodiscard]] BallMatrix operator-(const BallMatrix& a, const BallMatrix& b);
[[nodiscard]] BallMatrix operator*(const BallMatrix& a, const BallMatrix& b);
/// Holds the inverses of all matrices in it; throws core::NumericalError where it cannot tell that they have one.
[[nodiscard]] BallMatrix inverse(const BallMatrix& a);
/// Upper bounds of the entries of exp(a) - 1 for all matrices whose entries are at most those of `a` in modulus.
[[nodiscard]] BallMatrix growth_bound(const BallMatrix& a);

}  // namespace orbweaver::prove
