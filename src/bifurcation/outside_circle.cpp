#include "orbweaver/bifurcation/outside_circle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdlib>

namespace orbweaver::bifurcation {

std::optional<OutsideCircle> outside_circle(const systems::Structure& system, const spectrum::Stability& stability) {
  if (system.symplectic) return std::nullopt;
  OutsideCircle out;
  const std::size_t count = stability.fundamental.size() - (system.conservative() ? 1 : 0);  // the last is the energy's
  for (std::size_t n = 0; n < count; ++n) {
    const std::complex<double>& multiplier = stability.fundamental[n];
    const double error = stability.fundamental_error[n];
    const double beyond = std::abs(multiplier) - 1.0;
    if (!(std::abs(beyond) > error)) return std::nullopt;
    if (beyond < 0.0 || multiplier.imag() < 0.0) continue;  // of a pair the other one counts
    if (multiplier.imag() > error)
      ++out.pairs;
    else  // two that are equal may be a complex pair to rounding
      (multiplier.real() > 0.0 ? out.beyond_one : out.beyond_minus_one) += multiplier.imag() > 0.0 ? 2 : 1;
  }
  return out;
}

CirclePassages least_passages(const OutsideCircle& from, const OutsideCircle& to) {
  const int one = to.beyond_one - from.beyond_one;
  const int minus_one = to.beyond_minus_one - from.beyond_minus_one;
  const int pairs = to.pairs - from.pairs;
  const int outside = std::abs(one + minus_one + 2 * pairs);
  const int odd_one = std::abs(one % 2);
  const int odd_minus_one = std::abs(minus_one % 2);
  const int least = std::max(outside, odd_one + odd_minus_one);
  if (std::abs(one) + std::abs(minus_one) + 2 * std::abs(pairs) == least)
    return {std::abs(one), std::abs(minus_one), std::abs(pairs)};
  return {odd_one, odd_minus_one, (least - odd_one - odd_minus_one) / 2};
}

}  // namespace orbweaver::bifurcation
