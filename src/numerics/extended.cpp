#include "orbweaver/numerics/extended.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <regex>

#include "orbweaver/core/error.hpp"

namespace orbweaver::numerics {

WorkingDigits::WorkingDigits(int digits) : _before(Extended::default_precision()) {
  core::require(digits > 0, "a number has digits");
  Extended::default_precision(static_cast<unsigned>(digits));
}

WorkingDigits::~WorkingDigits() { Extended::default_precision(_before); }

Extended rounded(const Extended& x) {
  Extended result;
  mpfr_set(result.backend().data(), x.backend().data(), MPFR_RNDN);
  return result;
}

void add_to(Extended& x, const Extended& by) {
  mpfr_add(x.backend().data(), x.backend().data(), by.backend().data(), MPFR_RNDN);
}

double log10_abs(const Extended& x) {
  if (mpfr_zero_p(x.backend().data())) return -std::numeric_limits<double>::infinity();
  long exponent = 0;
  const double mantissa = mpfr_get_d_2exp(&exponent, x.backend().data(), MPFR_RNDN);
  return std::log10(std::abs(mantissa)) + static_cast<double>(exponent) * std::log10(2.0);
}

double log10_abs(double x) { return std::log10(std::abs(x)); }

Extended extended_of(const std::string& decimal) {
  static const std::regex number(R"([+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,6})?)");
  if (!std::regex_match(decimal, number))
    throw core::InputError("expected a decimal number such as 9 or -1.25e-3, got `" + decimal + "`");
  Extended result;
  mpfr_set_str(result.backend().data(), decimal.c_str(), 10, MPFR_RNDN);
  return result;
}

std::string shortest_decimal(double x) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return {text, end};
}

std::string decimal_text(const Extended& x, int digits) {
  if (mpfr_zero_p(x.backend().data())) return "0";
  if (!mpfr_number_p(x.backend().data())) return mpfr_nan_p(x.backend().data()) ? "nan" : "inf";
  mpfr_exp_t exponent = 0;  // 0.d1d2d3... 10^exponent
  char* raw = mpfr_get_str(nullptr, &exponent, 10, static_cast<std::size_t>(std::max(digits, 2)), x.backend().data(),
                           MPFR_RNDN);
  std::string text(raw);
  mpfr_free_str(raw);
  const bool negative = text.front() == '-';
  if (negative) text.erase(0, 1);
  constexpr mpfr_exp_t longest_zeros = -3;
  constexpr mpfr_exp_t longest_whole = 7;
  std::string result;
  if (exponent > longest_zeros && exponent <= 0)
    result = "0." + std::string(static_cast<std::size_t>(-exponent), '0') + text;
  else if (exponent > 0 && exponent <= longest_whole && exponent < static_cast<mpfr_exp_t>(text.size()))
    result = text.substr(0, static_cast<std::size_t>(exponent)) + "." + text.substr(static_cast<std::size_t>(exponent));
  else
    result = text.substr(0, 1) + "." + text.substr(1) + "e" + std::to_string(exponent - 1);
  return (negative ? "-" : "") + result;
}

}  // namespace orbweaver::numerics
