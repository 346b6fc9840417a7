#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::test {

/// The largest of `full_error`, relative to 1 + the modulus of its entry.
inline double relative_error(const spectrum::Stability& stability) {
  double largest = 0.0;
  for (std::size_t n = 0; n < stability.full.size(); ++n)
    largest = std::max(largest, stability.full_error[n] / (1.0 + std::abs(stability.full[n])));
  return largest;
}

}  // namespace orbweaver::test
