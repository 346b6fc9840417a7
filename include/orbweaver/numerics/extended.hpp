#pragma once

#include <string>

#include <Eigen/Dense>
#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/mpfr.hpp>

namespace orbweaver::numerics {

/// A floating-point number of as many digits as wanted (MPFR): new ones have those of the WorkingDigits in force.
using Extended =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<0>, boost::multiprecision::et_off>;
using ExtendedVector = Eigen::Matrix<Extended, Eigen::Dynamic, 1>;
using ExtendedMatrix = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic>;

/// While it lives, new numbers of this thread have `digits` decimal digits. They nest.
class WorkingDigits {
 public:
  explicit WorkingDigits(int digits);
  ~WorkingDigits();
  WorkingDigits(const WorkingDigits&) = delete;
  WorkingDigits& operator=(const WorkingDigits&) = delete;

 private:
  unsigned _before;
};

/// The number with the working digits.
[[nodiscard]] Extended rounded(const Extended& x);

/// `x += by` with the digits that x has.
void add_to(Extended& x, const Extended& by);

/// log10 |x|, to about 1e-15; -infinity for 0.
[[nodiscard]] double log10_abs(const Extended& x);
[[nodiscard]] double log10_abs(double x);

/// The decimal number "9", "-1.25e-3", rounded to the working digits. Throws core::InputError for a text that is none.
[[nodiscard]] Extended extended_of(const std::string& decimal);

/// What a person means who writes a double: the shortest decimal number that reads as it.
[[nodiscard]] std::string shortest_decimal(double x);

/// "-1.2345", rounded to `digits` significant digits; with an exponent beyond 1e-4 and 1e7.
[[nodiscard]] std::string decimal_text(const Extended& x, int digits);

}  // namespace orbweaver::numerics
