// check_action ATLAS TOLERANCE: dW/dE = T along every family, W the action and E the energy. Both are taken as
// polynomials of degree 6 in the period (which grows along these families) through seven neighbouring orbits: an error
// of sixth order in the steps.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/reader.hpp"

namespace {

constexpr std::size_t neighbours = 3;  // on either side

// The derivative at x[at] of the polynomial through its neighbours.
double derivative(const double* x, const double* y, std::size_t at) {
  double sum = 0.0;
  for (std::size_t j = at - neighbours; j <= at + neighbours; ++j) {
    if (j == at) continue;
    double weight = 1.0 / (x[j] - x[at]);
    for (std::size_t m = at - neighbours; m <= at + neighbours; ++m)
      if (m != j && m != at) weight *= (x[at] - x[m]) / (x[j] - x[m]);
    sum += weight * (y[j] - y[at]);
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: check_action ATLAS TOLERANCE\n");
    return 2;
  }
  const double tolerance = std::strtod(argv[2], nullptr);
  const orbweaver::archive::Archive atlas(argv[1]);
  const auto& orbits = atlas.orbits();
  bool good = atlas.families().rows() > 0;
  for (std::size_t n = 0; n < atlas.families().rows(); ++n) {
    const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[n]);
    const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[n]);
    const double* period = orbits.reals("period").data() + first;
    double worst = 0.0;
    for (std::size_t at = neighbours; at + neighbours < count; ++at) {
      const double slope = derivative(period, orbits.reals("action").data() + first, at) /
                           derivative(period, orbits.reals("energy").data() + first, at);
      worst = std::max(worst, std::abs(slope / period[at] - 1.0));
    }
    fmt::print("{}: dW/dE is T within {:.1e} at {} orbits, wanted {:.1e}\n", atlas.families().texts("name")[n], worst,
               count, tolerance);
    good = good && count > 2 * neighbours && worst < tolerance;
  }
  return good ? 0 : 1;
}
