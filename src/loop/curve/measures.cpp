// Means over time: Parseval's equation where s runs evenly with time, sums over nodes weighted by the time map's
// density otherwise.
#include "orbweaver/loop/curve/measures.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "resampled.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

double squared_norm(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum;
}

double squared_norm_of_harmonic(const Loop& loop, int k) {
  const auto d = static_cast<std::size_t>(loop.dimension);
  return squared_norm(std::span(loop.modes).subspan((2 * static_cast<std::size_t>(k) - 1) * d, 2 * d));
}

std::vector<double> weights_of(const TimeMap& map, int nodes) {
  std::vector<double> weights = densities(map, nodes);
  for (double& w : weights) w /= nodes;
  return weights;
}

// z - n 2 pi t / T at nodes: what oscillates.
Samples oscillation_of(const Loop& loop) {
  Samples out{nodes_for(loop), {}, {}};
  const auto n = static_cast<std::size_t>(out.nodes);
  out.weights = weights_of(loop.time_map, out.nodes);
  out.states.resize(static_cast<std::size_t>(loop.dimension) * n);
  FourierGrid::of_size(out.nodes).synthesize(loop.cutoff, loop.dimension, loop.modes.data(), out.states.data());
  for (std::size_t i = 0; i < loop.winding.size(); ++i) {
    if (loop.winding[i] == 0.0) continue;
    for (std::size_t j = 0; j < n; ++j) {
      const double s = two_pi * static_cast<double>(j) / out.nodes;
      out.states[i * n + j] += loop.winding[i] * (s - loop.time_map.phase(s));
    }
  }
  return out;
}

// sum_j weights_j |z_j - centre|^2.
double mean_square(const Samples& samples, std::span<const double> centre) {
  const auto n = static_cast<std::size_t>(samples.nodes);
  double sum = 0.0;
  for (std::size_t i = 0; i < centre.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double gap = samples.states[i * n + j] - centre[i];
      sum += samples.weights[j] * gap * gap;
    }
  return sum;
}

std::vector<double> mean_of(const Samples& samples, int dimension) {
  const auto n = static_cast<std::size_t>(samples.nodes);
  std::vector<double> mean(static_cast<std::size_t>(dimension), 0.0);
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) mean[i] += samples.weights[j] * samples.states[i * n + j];
  return mean;
}

double distance_by_parseval(const Loop& a, const Loop& b) {
  const std::size_t shared = std::min(a.modes.size(), b.modes.size());
  const std::vector<double>& longer = a.modes.size() > b.modes.size() ? a.modes : b.modes;
  const auto d = static_cast<std::size_t>(a.dimension);
  double sum = 0.0;
  for (std::size_t n = 0; n < longer.size(); ++n) {
    const double difference = n < shared ? a.modes[n] - b.modes[n] : longer[n];
    sum += (n < d ? 1.0 : 0.5) * difference * difference;
  }
  return std::sqrt(sum);
}

// The shortest time between two nodes, as a part of the period.
double finest_spacing(const Loop& loop) {
  const std::vector<double> weights = weights_of(loop.time_map, nodes_for(loop));
  return *std::min_element(weights.begin(), weights.end());
}

}  // namespace

int nodes_for(const Loop& loop) {
  const int nodes = FourierGrid::nodes_for(loop.cutoff);
  const int of_map = loop.time_map.is_identity() ? 0 : nodes_to_resolve(loop.time_map);
  return of_map <= nodes ? nodes : FourierGrid::nodes_at_least(of_map);
}

Samples samples_of(const Loop& loop) { return samples_of(loop, nodes_for(loop)); }

Samples samples_of(const Loop& loop, int nodes) {
  Samples out{nodes, {}, {}};
  const auto n = static_cast<std::size_t>(out.nodes);
  out.weights = weights_of(loop.time_map, out.nodes);
  out.states.resize(static_cast<std::size_t>(loop.dimension) * n);
  FourierGrid::of_size(out.nodes).synthesize(loop.cutoff, loop.dimension, loop.modes.data(), out.states.data());
  for (std::size_t i = 0; i < loop.winding.size(); ++i)
    for (std::size_t j = 0; j < n; ++j)
      out.states[i * n + j] += loop.winding[i] * two_pi * static_cast<double>(j) / out.nodes;
  return out;
}

double mean_distance(const Loop& a, const Loop& b) {
  core::require(a.dimension == b.dimension, "loops of different dimension have no distance");
  core::require(a.winding == b.winding, "loops that wind differently have no distance");
  const bool same_map = a.time_map == b.time_map;
  if (same_map && a.time_map.is_identity()) return distance_by_parseval(a, b);
  const std::vector<double> origin(static_cast<std::size_t>(a.dimension), 0.0);
  if (same_map) {
    Loop gap = with_cutoff(a, std::max(a.cutoff, b.cutoff));
    for (std::size_t n = 0; n < b.modes.size(); ++n) gap.modes[n] -= b.modes[n];
    std::fill(gap.winding.begin(), gap.winding.end(), 0.0);
    return std::sqrt(mean_square(samples_of(gap), origin));
  }
  // On nodes of the loop with the finer ones: the other is smooth there.
  const bool a_is_finer = finest_spacing(a) <= finest_spacing(b);
  const Loop& fine = a_is_finer ? a : b;
  const Loop& coarse = a_is_finer ? b : a;
  const int nodes = FourierGrid::nodes_at_least(2 * std::max(nodes_for(a), nodes_for(b)));
  Samples gap{nodes, weights_of(fine.time_map, nodes), resampled(coarse, fine.time_map, nodes)};
  std::vector<double> other(gap.states.size());
  FourierGrid::of_size(nodes).synthesize(fine.cutoff, fine.dimension, fine.modes.data(), other.data());
  for (std::size_t m = 0; m < other.size(); ++m) gap.states[m] -= other[m];
  return std::sqrt(mean_square(gap, origin));
}

double rms_speed(const Loop& loop) {
  const double rate = two_pi / loop.period;
  if (loop.time_map.is_identity()) {
    double sum = 0.0;
    for (int k = loop.cutoff; k >= 1; --k) sum += 0.5 * k * k * squared_norm_of_harmonic(loop, k);
    return rate * std::sqrt(sum + squared_norm(loop.winding));
  }
  const int nodes = nodes_for(loop);
  const auto n = static_cast<std::size_t>(nodes);
  const std::vector<double> density = densities(loop.time_map, nodes);
  std::vector<double> slope(static_cast<std::size_t>(loop.dimension) * n);
  FourierGrid::of_size(nodes).synthesize_derivative(loop.cutoff, loop.dimension, loop.modes.data(), slope.data());
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.winding.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double v = slope[i * n + j] + loop.winding[i];
      sum += v * v / density[j];
    }
  return rate * std::sqrt(sum / nodes);
}

std::vector<double> mean_state(const Loop& loop) {
  if (loop.time_map.is_identity())
    return {loop.modes.begin(), loop.modes.begin() + static_cast<std::ptrdiff_t>(loop.dimension)};
  return mean_of(oscillation_of(loop), loop.dimension);
}

double rms_amplitude(const Loop& loop) {
  if (loop.time_map.is_identity()) {
    double sum = 0.0;
    for (int k = loop.cutoff; k >= 1; --k) sum += 0.5 * squared_norm_of_harmonic(loop, k);
    return std::sqrt(sum);
  }
  const Samples samples = oscillation_of(loop);
  return std::sqrt(mean_square(samples, mean_of(samples, loop.dimension)));
}

double rms_size(const Loop& loop) {
  const double amplitude = rms_amplitude(loop);
  return std::sqrt(squared_norm(mean_state(loop)) + amplitude * amplitude);
}

}  // namespace orbweaver::loop
