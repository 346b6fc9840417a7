#include "symmetry/mapped_shift.hpp"

#include <algorithm>
#include <cmath>

#include "curve/resampled.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

/// Steps: each leaves the part of the last that the loops' slopes differ by.
constexpr int most_shift_steps = 30;
/// Of the distance, what the loop moves in the last step: the distance changes by the square of that.
constexpr double settled_distance = 1e-6;
constexpr double rounding = 1e-15;  // of a shift

}  // namespace

double mapped_shift_near(const Loop& y, const Loop& x, const std::vector<int>& angles, double shift) {
  core::require(y.dimension == x.dimension && y.winding == x.winding,
                "a shift is sought between loops that wind alike");
  const int nodes = FourierGrid::nodes_at_least(2 * std::max(nodes_for(x), nodes_for(y)));
  const auto n = static_cast<std::size_t>(nodes);
  const std::vector<double> density = densities(x.time_map, nodes);
  std::vector<double> values(static_cast<std::size_t>(x.dimension) * n);
  std::vector<double> slope(values.size());  // dz/ds; over the density dz/d(2 pi t/T)
  const FourierGrid& grid = FourierGrid::of_size(nodes);
  grid.synthesize(x.cutoff, x.dimension, x.modes.data(), values.data());
  grid.synthesize_derivative(x.cutoff, x.dimension, x.modes.data(), slope.data());
  double speed = 0.0;
  for (std::size_t i = 0; i < x.winding.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) {
      slope[i * n + j] += x.winding[i];
      speed += slope[i * n + j] * slope[i * n + j] / density[j] / nodes;
    }
  if (!(speed > 0.0)) return shift;
  for (int step = 0; step < most_shift_steps; ++step) {
    std::vector<double> gap = resampled(time_shifted(y, shift), x.time_map, nodes);
    double along = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < x.winding.size(); ++i) {
      double mean = 0.0;
      for (std::size_t j = 0; j < n; ++j) mean += density[j] * (gap[i * n + j] -= values[i * n + j]) / nodes;
      const bool is_angle = std::find(angles.begin(), angles.end(), static_cast<int>(i)) != angles.end();
      const double turns = is_angle ? two_pi * std::round(mean / two_pi) : 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        const double apart = gap[i * n + j] - turns;
        along += apart * slope[i * n + j] / nodes;
        square += density[j] * apart * apart / nodes;
      }
    }
    const double change = along / speed;  // of 2 pi psi
    shift -= change / two_pi;
    if (std::abs(change) < rounding || change * change * speed <= settled_distance * settled_distance * square) break;
  }
  return shift;
}

}  // namespace orbweaver::loop
