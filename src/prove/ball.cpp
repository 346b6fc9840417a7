#include "ball.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include <acb_hypgeom.h>
#include <arb_hypgeom.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::prove {

namespace {

constexpr long first_bits = 128;  // until WorkingBits says otherwise
thread_local long bits_in_force = first_bits;

constexpr std::size_t longest_echo = 200;

/// Whether the exponents, the second and the fourth number, have no more hexadecimal digits than a computation's: the
/// decimal digits of others would take all memory.
bool has_usual_exponents(const std::string& text) {
  constexpr std::size_t most_digits = 6;
  std::istringstream words(text);
  std::string mantissa;
  std::string exponent;
  while (words >> mantissa >> exponent)
    if (exponent.size() > most_digits + (exponent.starts_with('-') ? 1 : 0)) return false;
  return true;
}

double rounded_outwards(const arf_t x, arf_rnd_t way) { return arf_get_d(x, way); }

}  // namespace

WorkingBits::WorkingBits(long bits) : _before(bits_in_force) {
  core::require(bits > 1, "a number has bits");
  bits_in_force = bits;
}

WorkingBits::~WorkingBits() { bits_in_force = _before; }

long WorkingBits::in_force() { return bits_in_force; }

Ball Ball::of_decimal(const std::string& decimal) {
  static_cast<void>(numerics::extended_of(decimal));  // refuses what is no number
  Ball result;
  if (arb_set_str(result._ball, decimal.c_str(), bits_in_force) != 0)
    throw core::InputError("expected a decimal number such as 9 or -1.25e-3, got `" + decimal + "`");
  return result;
}

Ball Ball::of(const numerics::Extended& exact) {
  Ball result;
  arf_set_mpfr(arb_midref(result._ball), exact.backend().data());
  return result;
}

Ball Ball::of_exact_text(const std::string& text) {
  Ball result;
  if (!has_usual_exponents(text) || arb_load_str(result._ball, text.c_str()) != 0)
    throw core::InputError("expected a ball as four whole numbers, got `" +
                           core::shortened(core::printable(text), longest_echo) + "`");
  return result;
}

Ball Ball::pi() {
  Ball result;
  arb_const_pi(result._ball, bits_in_force);
  return result;
}

Ball Ball::around_zero(const Ball& radius) { return Ball().widened(radius); }

Ball Ball::middle() const {
  Ball result;
  arb_get_mid_arb(result._ball, _ball);
  return result;
}

Ball Ball::radius() const {
  Ball result;
  arb_get_rad_arb(result._ball, _ball);
  return result;
}

Ball Ball::modulus() const {
  mag_t size;
  mag_init(size);
  arb_get_mag(size, _ball);
  Ball result;
  arf_set_mag(arb_midref(result._ball), size);
  mag_clear(size);
  return result;
}

double Ball::middle_in_double() const { return arf_get_d(arb_midref(_ball), ARF_RND_NEAR); }

double Ball::lower() const {
  arf_t end;
  arf_init(end);
  arb_get_lbound_arf(end, _ball, bits_in_force);
  const double result = rounded_outwards(end, ARF_RND_FLOOR);
  arf_clear(end);
  return result;
}

double Ball::upper() const {
  arf_t end;
  arf_init(end);
  arb_get_ubound_arf(end, _ball, bits_in_force);
  const double result = rounded_outwards(end, ARF_RND_CEIL);
  arf_clear(end);
  return result;
}

Ball Ball::widened(const Ball& error) const {
  Ball result = *this;
  arb_add_error(result._ball, error._ball);
  return result;
}

std::string Ball::exact_text() const {
  char* raw = arb_dump_str(_ball);
  std::string text(raw);
  flint_free(raw);
  return text;
}

Ball& Ball::operator+=(const Ball& b) {
  arb_add(_ball, _ball, b._ball, bits_in_force);
  return *this;
}

Ball& Ball::operator-=(const Ball& b) {
  arb_sub(_ball, _ball, b._ball, bits_in_force);
  return *this;
}

Ball& Ball::operator*=(const Ball& b) {
  arb_mul(_ball, _ball, b._ball, bits_in_force);
  return *this;
}

Ball& Ball::operator/=(const Ball& b) {
  arb_div(_ball, _ball, b._ball, bits_in_force);
  return *this;
}

Ball operator+(Ball a, const Ball& b) { return a += b; }
Ball operator-(Ball a, const Ball& b) { return a -= b; }
Ball operator*(Ball a, const Ball& b) { return a *= b; }
Ball operator/(Ball a, const Ball& b) { return a /= b; }

Ball operator-(Ball a) {
  arb_neg(a.get(), a.get());
  return a;
}

bool operator<(const Ball& a, const Ball& b) { return arb_lt(a.get(), b.get()) != 0; }
bool operator<=(const Ball& a, const Ball& b) { return arb_le(a.get(), b.get()) != 0; }

#define ORBWEAVER_BALL_FUNCTION(name)                 \
  Ball name(const Ball& x) {                          \
    Ball result;                                      \
    arb_##name(result.get(), x.get(), bits_in_force); \
    return result;                                    \
  }
ORBWEAVER_BALL_FUNCTION(sqrt)
ORBWEAVER_BALL_FUNCTION(exp)
ORBWEAVER_BALL_FUNCTION(log)
ORBWEAVER_BALL_FUNCTION(sin)
ORBWEAVER_BALL_FUNCTION(cos)
ORBWEAVER_BALL_FUNCTION(asin)
ORBWEAVER_BALL_FUNCTION(acos)
ORBWEAVER_BALL_FUNCTION(atan)
ORBWEAVER_BALL_FUNCTION(tanh)
ORBWEAVER_BALL_FUNCTION(hypgeom_erf)
#undef ORBWEAVER_BALL_FUNCTION

Ball erf(const Ball& x) { return hypgeom_erf(x); }

Ball pow(const Ball& x, const Ball& exponent) {
  Ball result;
  arb_pow(result.get(), x.get(), exponent.get(), bits_in_force);
  return result;
}

Ball ComplexBall::real() const {
  Ball result;
  arb_set(result.get(), acb_realref(_ball));
  return result;
}

Ball ComplexBall::imaginary() const {
  Ball result;
  arb_set(result.get(), acb_imagref(_ball));
  return result;
}

Ball ComplexBall::modulus() const {
  mag_t size;
  mag_init(size);
  acb_get_mag(size, _ball);
  Ball result;
  arf_set_mag(arb_midref(result.get()), size);
  mag_clear(size);
  return result;
}

#define ORBWEAVER_COMPLEX_OPERATION(symbol, name)                           \
  ComplexBall operator symbol(const ComplexBall& a, const ComplexBall& b) { \
    ComplexBall result;                                                     \
    acb_##name(result.get(), a.get(), b.get(), bits_in_force);              \
    return result;                                                          \
  }
ORBWEAVER_COMPLEX_OPERATION(+, add)
ORBWEAVER_COMPLEX_OPERATION(-, sub)
ORBWEAVER_COMPLEX_OPERATION(*, mul)
ORBWEAVER_COMPLEX_OPERATION(/, div)
#undef ORBWEAVER_COMPLEX_OPERATION

ComplexBall operator-(const ComplexBall& a) {
  ComplexBall result;
  acb_neg(result.get(), a.get());
  return result;
}

ComplexBall sqrt(const ComplexBall& x) {
  ComplexBall result;
  acb_sqrt_analytic(result.get(), x.get(), 1, bits_in_force);
  return result;
}

ComplexBall exp(const ComplexBall& x) {
  ComplexBall result;
  acb_exp(result.get(), x.get(), bits_in_force);
  return result;
}

ComplexBall log(const ComplexBall& x) {
  ComplexBall result;
  acb_log_analytic(result.get(), x.get(), 1, bits_in_force);
  return result;
}

ComplexBall sin(const ComplexBall& x) {
  ComplexBall result;
  acb_sin(result.get(), x.get(), bits_in_force);
  return result;
}

ComplexBall cos(const ComplexBall& x) {
  ComplexBall result;
  acb_cos(result.get(), x.get(), bits_in_force);
  return result;
}

ComplexBall tanh(const ComplexBall& x) {
  ComplexBall result;
  acb_tanh(result.get(), x.get(), bits_in_force);
  return result;
}

ComplexBall erf(const ComplexBall& x) {
  ComplexBall result;
  acb_hypgeom_erf(result.get(), x.get(), bits_in_force);
  return result;
}

namespace {

ComplexBall not_finite() {
  ComplexBall result;
  acb_indeterminate(result.get());
  return result;
}

}  // namespace

ComplexBall asin(const ComplexBall&) { return not_finite(); }
ComplexBall acos(const ComplexBall&) { return not_finite(); }
ComplexBall atan(const ComplexBall&) { return not_finite(); }

BallMatrix BallMatrix::identity(std::size_t size) {
  BallMatrix result(size, size);
  arb_mat_one(result._matrix);
  return result;
}

BallMatrix BallMatrix::of(const BallVector& column) {
  BallMatrix result(column.size(), 1);
  for (std::size_t i = 0; i < column.size(); ++i) result.set(i, 0, column[i]);
  return result;
}

Ball BallMatrix::at(std::size_t i, std::size_t j) const {
  Ball result;
  arb_set(result.get(), arb_mat_entry(_matrix, i, j));
  return result;
}

void BallMatrix::set(std::size_t i, std::size_t j, const Ball& value) {
  arb_set(arb_mat_entry(_matrix, i, j), value.get());
}

double BallMatrix::middle_in_double(std::size_t i, std::size_t j) const {
  return arf_get_d(arb_midref(arb_mat_entry(_matrix, i, j)), ARF_RND_NEAR);
}

BallVector BallMatrix::column(std::size_t j) const {
  BallVector result;
  for (std::size_t i = 0; i < rows(); ++i) result.push_back(at(i, j));
  return result;
}

BallMatrix BallMatrix::block(std::size_t row, std::size_t column, std::size_t rows, std::size_t columns) const {
  BallMatrix result(rows, columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      arb_set(arb_mat_entry(result._matrix, i, j), arb_mat_entry(_matrix, row + i, column + j));
  return result;
}

void BallMatrix::set_block(std::size_t row, std::size_t column, const BallMatrix& block) {
  for (std::size_t i = 0; i < block.rows(); ++i)
    for (std::size_t j = 0; j < block.columns(); ++j)
      arb_set(arb_mat_entry(_matrix, row + i, column + j), arb_mat_entry(block._matrix, i, j));
}

BallMatrix BallMatrix::middle() const {
  BallMatrix result(rows(), columns());
  arb_mat_get_mid(result._matrix, _matrix);
  return result;
}

Ball BallMatrix::trace() const {
  Ball result;
  arb_mat_trace(result.get(), _matrix, bits_in_force);
  return result;
}

BallMatrix operator+(const BallMatrix& a, const BallMatrix& b) {
  BallMatrix result(a.rows(), a.columns());
  arb_mat_add(result.get(), a.get(), b.get(), bits_in_force);
  return result;
}

BallMatrix operator-(const BallMatrix& a, const BallMatrix& b) {
  BallMatrix result(a.rows(), a.columns());
  arb_mat_sub(result.get(), a.get(), b.get(), bits_in_force);
  return result;
}

BallMatrix operator*(const BallMatrix& a, const BallMatrix& b) {
  core::require(a.columns() == b.rows(), "matrices that can be multiplied");
  BallMatrix result(a.rows(), b.columns());
  arb_mat_mul(result.get(), a.get(), b.get(), bits_in_force);
  return result;
}

BallMatrix inverse(const BallMatrix& a) {
  BallMatrix result(a.rows(), a.columns());
  if (arb_mat_inv(result.get(), a.get(), bits_in_force) == 0)
    throw core::NumericalError("an enclosed matrix cannot be told from a singular one");
  return result;
}

BallMatrix growth_bound(const BallMatrix& a) {
  BallMatrix bound(a.rows(), a.columns());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < a.columns(); ++j) bound.set(i, j, a.at(i, j).modulus());
  BallMatrix result(a.rows(), a.columns());
  arb_mat_exp(result.get(), bound.get(), bits_in_force);
  result = result - BallMatrix::identity(a.rows());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < a.columns(); ++j) result.set(i, j, result.at(i, j).modulus());
  return result;
}

}  // namespace orbweaver::prove
