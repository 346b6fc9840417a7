#include "sampled_loop.hpp"

#include <algorithm>
#include <cmath>

#include "floquet_chain.hpp"
#include "lane_matrices.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::spectrum {

namespace {

using ad::Lanes;
using numerics::two_pi;

/// Largest sum over segments of (h |A|)^8, as for shorter ones: none has h |A| above 1.6.
constexpr double largest_long_sum = 43.0;
constexpr double power_of_long_segments = 7.0;

/// 2 pi phi'(s) at equidistant nodes. Those of a pulse repeat after half a turn and are even.
std::vector<double> densities_of(const loop::TimeMap& map, int nodes) {
  if (!map.coefficients.empty() || map.is_identity() || nodes % 4 != 0) return loop::densities(map, nodes);
  std::vector<double> out(static_cast<std::size_t>(nodes));
  const int half = nodes / 2;
  for (int j = 0; j <= nodes / 4; ++j) {
    const double density = map.density(two_pi * j / nodes);
    for (const int at : {j, half - j, half + j, (nodes - j) % nodes}) out[static_cast<std::size_t>(at)] = density;
  }
  return out;
}

}  // namespace

Numbers numbers(std::size_t count) { return std::make_unique_for_overwrite<double[]>(count); }

SampledLoop::SampledLoop(const systems::System& system, const loop::Loop& loop, int order, int around)
    : dimension(static_cast<std::size_t>(loop.dimension)), segments(static_cast<std::size_t>(around / order)) {
  const std::size_t d = dimension;
  const int grid = around * static_cast<int>(parts);
  const int skipped = 2 * loop.cutoff / grid + 1;
  const int fine = grid * skipped;
  const auto fine_size = static_cast<std::size_t>(fine);
  const Numbers nodal = numbers(d * fine_size);
  const Numbers slopes = numbers(d * fine_size);
  const loop::FourierGrid& fourier = loop::FourierGrid::of_size(fine);
  fourier.synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.get());
  fourier.synthesize_derivative(loop.cutoff, loop.dimension, loop.modes.data(), slopes.get());
  const std::vector<double> densities = densities_of(loop.time_map, grid);

  const std::size_t columns = segments + 1 + 2 * guards;
  stride = (columns + wide - 1) / wide * wide + wide;
  points = parts * stride;
  states = numbers(d * points);
  fields = numbers(d * points);
  jacobians = numbers(d * d * points);
  rates = numbers(points);
  residuals = numbers(d * points);
  const double step = two_pi / around;
  const double rate = loop.period / around;
  std::vector<std::size_t> nodes(stride);
  for (std::size_t c = 0; c < parts; ++c) {
    for (std::size_t m = 0; m < stride; ++m) {
      const int j = static_cast<int>(std::min(m, columns - 1) * parts + c) - static_cast<int>(guards * parts);
      nodes[m] = static_cast<std::size_t>(((j % grid) + grid) % grid);
      rates[c * stride + m] = rate * densities[nodes[m]];
    }
    for (std::size_t i = 0; i < d; ++i) {
      const double turning = loop.winding[i];
      const double* z = &nodal[i * fine_size];
      const double* slope = &slopes[i * fine_size];
      double* state = &states[i * points + c * stride];
      double* residual = &residuals[i * points + c * stride];
      for (std::size_t m = 0; m < stride; ++m) {
        state[m] = z[nodes[m] * static_cast<std::size_t>(skipped)];
        residual[m] = step * (slope[nodes[m] * static_cast<std::size_t>(skipped)] + turning);
      }
      if (turning == 0.0) continue;
      const double first = static_cast<double>(c) * part - static_cast<double>(guards);
      for (std::size_t m = 0; m < stride; ++m)
        state[m] += turning * step * (first + static_cast<double>(std::min(m, columns - 1)));
    }
  }
  system.field_jacobian(points, states.get(), fields.get(), jacobians.get());
  node_jacobians = numbers(d * d * stride);
  for (std::size_t entry = 0; entry < d * d; ++entry)
    std::copy_n(&jacobians[entry * points], stride, &node_jacobians[entry * stride]);
  Lanes sum = 0.0;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t n = 0; n < points; n += wide) {
      const Lanes residual =
          Lanes::load(&residuals[i * points + n]) - Lanes::load(&rates[n]) * Lanes::load(&fields[i * points + n]);
      residual.store(&residuals[i * points + n]);
      sum += residual;
    }
  for (std::size_t l = 0; l < wide; ++l) require_finite_field(sum.packed[l]);
  for (std::size_t entry = 0; entry < d * d; ++entry)
    for (std::size_t n = 0; n < points; n += wide)
      (Lanes::load(&rates[n]) * Lanes::load(&jacobians[entry * points + n]))
          .store(&jacobians[entry * points + n]);
  vanishes.assign(d * d, 1);
  for (std::size_t entry = 0; entry < d * d; ++entry) {
    const double* all = &jacobians[entry * points];
    vanishes[entry] = std::all_of(all, all + points, [](double value) { return value == 0.0; });
  }
  if (dimension == 4)
    take_rates<4>(order, around);
  else
    take_rates<0>(order, around);
}

template <std::size_t D>
void SampledLoop::take_rates(int order, int around) {
  const LaneMatrices<D> of(dimension);
  const std::size_t dd = of.size();
  std::vector<Lanes> storage(3 * dd);
  Lanes* a = storage.data();
  double sum = 0.0;
  double largest = 0.0;
  for (std::size_t first = 0; first < segments; first += wide) {
    for (std::size_t n = 0; n < dd; ++n) a[n] = Lanes::load(&jacobians[n * points + guards + first]);
    of.multiply(a, a, a + dd);
    of.multiply(a + dd, a + dd, a + 2 * dd);
    Lanes square = 0.0;
    for (std::size_t n = 2 * dd; n < 3 * dd; ++n) square += a[n] * a[n];
    for (std::size_t l = 0; l < wide && first + l < segments; ++l) {
      sum += square.packed[l];
      largest = std::max(largest, square.packed[l]);
    }
  }
  wanted = around * std::pow(order * sum / largest_long_sum, 1.0 / power_of_long_segments);
  require_finite_rates(wanted);
  largest_rate = std::pow(largest, 1.0 / 8.0);
}

/// The loop is off the orbit by e, de/ds = t' A e - r. Trapezoidal sums of r miss much of the fastest waves, those of
/// the harmonics that the loop lacks, which differences between neighbours tell: e is these and the solution for what
/// they leave of r.
template <std::size_t D>
void SampledLoop::split() {
  const HermiteRule& rule = hermite_rule();
  const LaneMatrices<D> of(dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  fast = numbers(d * points);
  std::vector<Lanes> storage(dd + 2 * d);
  Lanes* a = storage.data();
  Lanes* waves = a + dd;
  Lanes* driven = waves + d;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t c = 0; c < parts; ++c)
      for (std::size_t first = guards; first <= guards + segments; first += wide) {
        const double* left = &residuals[i * points];
        Lanes sum = 0.0;
        for (std::size_t k = 1; k <= HermiteRule::fast_reach; ++k) {
          const std::size_t back = (k + parts - 1 - c) / parts;
          const Lanes plus = Lanes::load(left + (c + k) % parts * stride + first + (c + k) / parts);
          const Lanes minus = Lanes::load(left + (c + back * parts - k) * stride + first - back);
          sum += rule.fast[k - 1] * (plus - minus);
        }
        (-part * sum).store(&fast[i * points + c * stride + first]);
      }
  for (std::size_t c = 0; c < parts; ++c)
    for (std::size_t first = guards; first <= guards + segments; first += wide) {
      const std::size_t at = c * stride + first;
      for (std::size_t n = 0; n < dd; ++n) a[n] = Lanes::load(&jacobians[n * points + at]);
      for (std::size_t i = 0; i < d; ++i) waves[i] = Lanes::load(&fast[i * points + at]);
      of.apply(a, waves, driven);
      for (std::size_t i = 0; i < d; ++i)
        (Lanes::load(&residuals[i * points + at]) - driven[i]).store(&residuals[i * points + at]);
    }
}

void SampledLoop::split_residuals() {
  if (dimension == 4)
    split<4>();
  else
    split<0>();
}

}  // namespace orbweaver::spectrum
