#include "orbweaver/loop/curve/loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "resampled.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

double harmonic_norm_squared(const Loop& loop, int k) {
  double sum = 0.0;
  for (int i = 0; i < loop.dimension; ++i)
    sum += loop.cosine(k, i) * loop.cosine(k, i) + loop.sine(k, i) * loop.sine(k, i);
  return sum;
}

}  // namespace

Loop constant_loop(std::span<const double> point, double period, int cutoff) {
  Loop loop;
  loop.dimension = static_cast<int>(point.size());
  loop.cutoff = cutoff;
  loop.period = period;
  core::require(!point.empty(), "a loop needs at least one coordinate");
  core::require(cutoff >= 1, "a loop needs a cutoff of at least one harmonic");
  loop.modes.assign((2 * static_cast<std::size_t>(cutoff) + 1) * point.size(), 0.0);
  loop.winding.assign(point.size(), 0.0);
  std::copy(point.begin(), point.end(), loop.modes.begin());
  validate(loop);
  return loop;
}

void validate(const Loop& loop) {
  core::require(loop.dimension >= 1, "a loop needs at least one coordinate");
  core::require(loop.cutoff >= 1, "a loop needs a cutoff of at least one harmonic");
  core::require(std::isfinite(loop.period) && loop.period > 0.0, "the period of a loop must be positive and finite");
  core::require(
      loop.modes.size() == (2 * static_cast<std::size_t>(loop.cutoff) + 1) * static_cast<std::size_t>(loop.dimension),
      "a loop needs (2 cutoff + 1) x dimension modes");
  core::require(loop.winding.size() == static_cast<std::size_t>(loop.dimension),
                "a loop needs a winding number a coordinate");
  core::require(std::all_of(loop.modes.begin(), loop.modes.end(), [](double v) { return std::isfinite(v); }),
                "a loop's modes must be finite");
  core::require(std::all_of(loop.parameters.begin(), loop.parameters.end(), [](double v) { return std::isfinite(v); }),
                "a loop's parameters must be finite");
  const TimeMap& map = loop.time_map;
  core::require(
      map.kappa > 0.0 && std::isfinite(map.kappa) && map.coefficients.size() % 2 == 0 &&
          std::all_of(map.coefficients.begin(), map.coefficients.end(), [](double c) { return std::isfinite(c); }),
      "a loop's time map needs a positive kappa and pairs of finite coefficients");
}

void validate_received(const Loop& loop) {
  const bool none = loop.dimension == 0 && loop.cutoff == 0 && loop.modes.empty() && loop.winding.empty();
  if (!none) validate(loop);
}

namespace {

/// Registers of harmonics whose sines and cosines take a tenth of a millisecond: then the work may be given up.
constexpr int registers_between_questions = 1 << 12;

}  // namespace

std::vector<double> state_at(const Loop& loop, double time) {
  // Reduced by whole turns before it is multiplied by k, so that large times keep their digits.
  const double turns = time / loop.period;
  const double whole = std::floor(turns);
  const double phase = two_pi * (turns - whole);
  const double s = loop.time_map.is_identity() ? phase : loop.time_map.inverse(phase);
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> z(d);
  for (std::size_t i = 0; i < d; ++i) z[i] = loop.winding[i] * (two_pi * whole + s) + loop.modes[i];
  constexpr int width = static_cast<int>(ad::Lanes::width);
  double angles[width];
  double cosines[width];
  double sines[width];
  int registers = 0;
  for (int top = loop.cutoff; top >= 1; top -= width) {
    if (++registers % registers_between_questions == 0) core::interruption_point();
    for (int n = 0; n < width; ++n) angles[n] = (top - n) * s;
    const ad::Lanes packed = ad::Lanes::load(angles);
    ad::cos(packed).store(cosines);
    ad::sin(packed).store(sines);
    for (int n = 0; n < std::min(width, top); ++n)
      for (int i = 0; i < loop.dimension; ++i)
        z[static_cast<std::size_t>(i)] += loop.cosine(top - n, i) * cosines[n] + loop.sine(top - n, i) * sines[n];
  }
  return z;
}

Loop with_cutoff(const Loop& loop, int cutoff) {
  core::require(cutoff >= 1, "a loop needs a cutoff of at least one harmonic");
  Loop out = loop;
  out.cutoff = cutoff;
  out.modes.resize((2 * static_cast<std::size_t>(cutoff) + 1) * static_cast<std::size_t>(loop.dimension), 0.0);
  return out;
}

Loop weighted_sum(const std::vector<const Loop*>& loops, const std::vector<double>& weights) {
  core::require(!loops.empty() && loops.size() == weights.size(), "a sum of loops needs a weight for each");
  int cutoff = 0;
  for (const Loop* loop : loops) cutoff = std::max(cutoff, loop->cutoff);
  Loop out = with_cutoff(*loops.front(), cutoff);
  std::fill(out.modes.begin(), out.modes.end(), 0.0);
  std::fill(out.parameters.begin(), out.parameters.end(), 0.0);
  out.period = 0.0;
  for (std::size_t n = 0; n < loops.size(); ++n) {
    const Loop one = with_cutoff(*loops[n], cutoff);
    core::require(one.dimension == out.dimension && one.parameters.size() == out.parameters.size(),
                  "a sum of loops needs loops of one system");
    for (std::size_t c = 0; c < out.modes.size(); ++c) out.modes[c] += weights[n] * one.modes[c];
    for (std::size_t p = 0; p < out.parameters.size(); ++p) out.parameters[p] += weights[n] * one.parameters[p];
    out.period += weights[n] * one.period;
  }
  return out;
}

Loop with_time_map(const Loop& loop, const TimeMap& map, int cutoff) {
  Loop out = with_cutoff(loop, cutoff);
  if (map == loop.time_map) return out;
  out.time_map = map;
  const int nodes = std::max(nodes_for(out), FourierGrid::nodes_for(loop.cutoff));
  const std::vector<double> nodal = resampled(loop, map, nodes);
  FourierGrid::of_size(nodes).analyze(cutoff, loop.dimension, nodal.data(), out.modes.data());
  return out;
}

Loop evenly_in_time(const Loop& loop, double negligible) {
  const double allowed = std::max(negligible, 2.0 * tail(loop));
  Loop even = with_time_map(loop, {}, allowed_cutoff_at_least(loop.cutoff));
  while (tail(even) > allowed && even.cutoff < most_in_time * loop.cutoff)
    even = with_time_map(loop, {}, next_cutoff(even.cutoff));
  return even;
}

Loop repeated(const Loop& loop, int times) {
  core::require(times >= 1, "a loop is repeated once or more");
  core::require(loop.time_map.is_identity(), "a loop is repeated with s even in time");
  Loop out = loop;
  out.period *= times;
  for (double& n : out.winding) n *= times;
  out.cutoff = allowed_cutoff_at_least(times * loop.cutoff);
  const auto d = static_cast<std::size_t>(loop.dimension);
  out.modes.assign((2 * static_cast<std::size_t>(out.cutoff) + 1) * d, 0.0);
  for (int i = 0; i < loop.dimension; ++i) {
    out.cosine(0, i) = loop.cosine(0, i);
    for (int k = 1; k <= loop.cutoff; ++k) {
      out.cosine(times * k, i) = loop.cosine(k, i);
      out.sine(times * k, i) = loop.sine(k, i);
    }
  }
  return out;
}

Loop parameter_shifted(const Loop& loop, double turns) {
  Loop out = loop;
  const double part = turns - std::floor(turns);
  for (int i = 0; i < loop.dimension; ++i) {
    out.cosine(0, i) += loop.winding[static_cast<std::size_t>(i)] * two_pi * turns;
    for (int k = 1; k <= loop.cutoff; ++k) {
      const double shift = k * part;
      const double angle = two_pi * (shift - std::floor(shift));
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      out.cosine(k, i) = loop.cosine(k, i) * c + loop.sine(k, i) * s;
      out.sine(k, i) = loop.sine(k, i) * c - loop.cosine(k, i) * s;
    }
  }
  out.time_map = loop.time_map.shifted(two_pi * part);
  return out;
}

Loop time_shifted(const Loop& loop, double fraction) {
  if (loop.time_map.is_invariant_under_shift(fraction)) return parameter_shifted(loop, fraction);
  return parameter_shifted(loop, loop.time_map.inverse(two_pi * fraction) / two_pi);
}

double tail(const Loop& loop) {
  const int first = loop.cutoff - std::max({2, std::min(4, loop.cutoff / 2), loop.cutoff / 32}) + 1;
  double largest = 0.0;
  for (int k = std::max(1, first); k <= loop.cutoff; ++k)
    largest = std::max(largest, std::sqrt(harmonic_norm_squared(loop, k)));
  return largest;
}

namespace {

// Steps of a fifth to two fifths: few Fourier plans, and an orbit never carries half again what it needs.
constexpr double least_ratio = 1.22;
constexpr std::int64_t largest_nodes = 1 << 22;  // K about two million: 128 MiB of modes for four coordinates

/// 3^a 5^b 7^c from 5 on, below the largest number of nodes, in order.
std::vector<int> small_odd_factors() {
  std::vector<int> numbers;
  for (std::int64_t threes = 1; threes < largest_nodes; threes *= 3)
    for (std::int64_t fives = threes; fives < largest_nodes; fives *= 5)
      for (std::int64_t n = fives; n < largest_nodes; n *= 7)
        if (n >= 5) numbers.push_back(static_cast<int>(n));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

// Greedy: from one allowed 2K + 1 the next is the smallest with ratio >= 1.22 (ratios come out between 1.22 and 1.4).
const std::vector<int>& allowed_cutoffs() {
  static const std::vector<int> table = [] {
    std::vector<int> cutoffs;
    int last = 3;
    cutoffs.push_back(1);
    for (const int n : small_odd_factors())
      if (n >= least_ratio * last) {
        cutoffs.push_back((n - 1) / 2);
        last = n;
      }
    return cutoffs;
  }();
  return table;
}

}  // namespace

int allowed_cutoff_at_least(int k) {
  const std::vector<int>& table = allowed_cutoffs();
  const auto it = std::lower_bound(table.begin(), table.end(), k);
  core::require(it != table.end(), "no allowed cutoff is that large");
  return *it;
}

int next_cutoff(int k) { return allowed_cutoff_at_least(k + 1); }

int previous_cutoff(int k) {
  const std::vector<int>& table = allowed_cutoffs();
  const auto it = std::lower_bound(table.begin(), table.end(), k);
  return it == table.begin() ? table.front() : *std::prev(it);
}

}  // namespace orbweaver::loop
