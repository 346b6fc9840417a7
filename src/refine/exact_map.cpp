#include "orbweaver/refine/exact_map.hpp"

#include <cmath>
#include <numbers>

namespace orbweaver::refine {

namespace {

/// Of entries of size 1 at most, as they come out of sines and products of a few matrices.
constexpr double same_entry = 1e-14;
/// Denominators that entries are looked for with.
constexpr int most_parts = 24;
/// Parts of a turn: sines and cosines of a turn of a polygon of 24 corners are cosines of such.
constexpr int most_parts_of_a_turn = 96;

}  // namespace

template <>
double pi<double>() {
  return std::numbers::pi;
}

template <>
numerics::Extended pi<numerics::Extended>() {
  numerics::Extended result;
  mpfr_const_pi(result.backend().data(), MPFR_RNDN);
  return result;
}

ExactMatrix::ExactMatrix(const Eigen::MatrixXd& declared) : _size(declared.rows()) {
  for (Eigen::Index i = 0; i < _size; ++i)
    for (Eigen::Index l = 0; l < _size; ++l) _entries.push_back(recognised(declared(i, l)));
}

ExactMatrix::Entry ExactMatrix::recognised(double declared) {
  const double size = std::abs(declared);
  const double sign = std::signbit(declared) ? -1.0 : 1.0;
  if (size == std::round(size)) return {Entry::Kind::rational, sign, static_cast<int>(size), 1, 0.0};
  for (int n = 2; n <= most_parts; ++n) {
    const double parts = size * n;
    if (std::abs(parts - std::round(parts)) < same_entry * n)
      return {Entry::Kind::rational, sign, static_cast<int>(std::round(parts)), n, 0.0};
    const double square = size * size * n;
    if (std::abs(square - std::round(square)) < same_entry * n)
      return {Entry::Kind::root, sign, static_cast<int>(std::round(square)), n, 0.0};
  }
  for (int n = 5; n <= most_parts_of_a_turn; ++n)
    for (int m = 1; 4 * m < n; ++m)
      if (std::abs(size - std::cos(2.0 * std::numbers::pi * m / n)) < same_entry)
        return {Entry::Kind::cosine, sign, m, n, 0.0};
  return {Entry::Kind::rational, sign, 0, 0, declared};
}

template <class Real>
Real ExactMatrix::value_of(const Entry& entry) {
  using std::cos, std::sqrt;
  if (entry.denominator == 0) return Real(entry.otherwise);
  const Real ratio = Real(entry.numerator) / entry.denominator;
  switch (entry.kind) {
    case Entry::Kind::rational: return entry.sign * ratio;
    case Entry::Kind::root: return entry.sign * Real(sqrt(ratio));
    case Entry::Kind::cosine: return entry.sign * Real(cos(Real(2 * pi<Real>() * ratio)));
  }
  return Real(0.0);
}

template <class Real>
Matrix<Real> ExactMatrix::value() const {
  Matrix<Real> result(_size, _size);
  for (Eigen::Index i = 0; i < _size; ++i)
    for (Eigen::Index l = 0; l < _size; ++l)
      result(i, l) = value_of<Real>(_entries[static_cast<std::size_t>(i * _size + l)]);
  return result;
}

template Matrix<double> ExactMatrix::value<double>() const;
template Matrix<numerics::Extended> ExactMatrix::value<numerics::Extended>() const;

}  // namespace orbweaver::refine
