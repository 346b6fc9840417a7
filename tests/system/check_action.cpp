// check_action ATLAS TOLERANCE: dW/dE = T along every family, W the action and E the energy. Both are taken as
// polynomials of degree 6 through seven neighbouring orbits, an error of sixth order in the steps: in the arclength,
// or in the period where it grows throughout, whichever is better. The energy may turn, so the gap between dW and T dE
// is held against T times the greatest slope of the energy among the seven. Families of fewer orbits are passed over.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/read/reader.hpp"

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

/// |dW/dx - T dE/dx| relative to T times the greatest slope of E among the neighbours.
double gap(const double* x, const double* action, const double* energy, double period, std::size_t at) {
  double slope = 0.0;
  for (std::size_t m = at - neighbours; m < at + neighbours; ++m)
    slope = std::max(slope, std::abs((energy[m + 1] - energy[m]) / (x[m + 1] - x[m])));
  return std::abs(derivative(x, action, at) / period - derivative(x, energy, at)) / slope;
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
  bool good = true;
  int checked = 0;
  for (std::size_t n = 0; n < atlas.families().rows(); ++n) {
    const auto first = atlas.families().integers("first_orbit")[n];
    const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[n]);
    const double* period = orbits.reals("period").data() + first;
    const double* s = orbits.reals("arclength").data() + first;
    const double* energy = orbits.reals("energy").data() + first;
    const double* action = orbits.reals("action").data() + first;
    double worst = 0.0;
    for (std::size_t at = neighbours; at + neighbours < count; ++at) {
      double off = gap(s, action, energy, period[at], at);
      if (std::is_sorted(period + at - neighbours, period + at + neighbours + 1))
        off = std::min(off, gap(period, action, energy, period[at], at));
      worst = std::max(worst, off);
    }
    fmt::print("{}: dW/dE is T within {:.1e} at {} orbits, wanted {:.1e}\n", atlas.families().texts("name")[n], worst,
               count, tolerance);
    checked += count > 2 * neighbours ? 1 : 0;
    good = good && worst < tolerance;
  }
  return good && checked >= 4 ? 0 : 1;
}
