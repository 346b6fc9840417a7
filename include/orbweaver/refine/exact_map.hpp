#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/numerics/extended.hpp"

namespace orbweaver::refine {

template <class Real>
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
template <class Real>
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// A matrix of a finite group that is declared in double, to as many digits as wanted: its entries are 0, products of a
/// whole number and 1/n or a square root of one of these, or cosines of parts of a turn (matrices of rotations and
/// reflections of a polygon). An entry that is none of these is taken for the double that it is.
class ExactMatrix {
 public:
  explicit ExactMatrix(const Eigen::MatrixXd& declared);

  /// With the digits in force.
  template <class Real>
  [[nodiscard]] Matrix<Real> value() const;

  /// sign times numerator/denominator, its root, or the cosine of that part of a turn.
  struct Entry {
    enum class Kind { rational, root, cosine } kind = Kind::rational;
    double sign = 1.0;
    int numerator = 0;
    int denominator = 1;
    double otherwise = 0.0;  ///< denominator 0: this number
  };
  /// Row after row.
  [[nodiscard]] const std::vector<Entry>& entries() const { return _entries; }

 private:
  static Entry recognised(double declared);
  template <class Real>
  static Real value_of(const Entry& entry);

  Eigen::Index _size;
  std::vector<Entry> _entries;
};

/// pi with the digits in force.
template <class Real>
[[nodiscard]] Real pi();

}  // namespace orbweaver::refine
