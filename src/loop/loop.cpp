#include "orbweaver/loop/loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

double squared_norm(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum;
}

std::span<const double> row(const Loop& loop, int r) {
  const auto d = static_cast<std::size_t>(loop.dimension);
  return {loop.modes.data() + static_cast<std::size_t>(r) * d, d};
}

double harmonic_norm_squared(const Loop& loop, int k) {
  return squared_norm(row(loop, 2 * k - 1)) + squared_norm(row(loop, 2 * k));
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
}

std::vector<double> state_at(const Loop& loop, double time) {
  const double turns = time / loop.period;
  const double s = two_pi * turns;
  // The phase is reduced by whole turns before it is multiplied by k, so that large times keep their digits.
  const double reduced = two_pi * (turns - std::floor(turns));
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> z(d);
  for (std::size_t i = 0; i < d; ++i) z[i] = loop.winding[i] * s + loop.modes[i];
  for (int k = loop.cutoff; k >= 1; --k) {
    const double c = std::cos(k * reduced);
    const double sn = std::sin(k * reduced);
    for (int i = 0; i < loop.dimension; ++i)
      z[static_cast<std::size_t>(i)] += loop.cosine(k, i) * c + loop.sine(k, i) * sn;
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

Loop time_shifted(const Loop& loop, double fraction) {
  Loop out = loop;
  const double whole_turns = fraction - std::floor(fraction);
  for (int i = 0; i < loop.dimension; ++i) {
    out.cosine(0, i) += loop.winding[static_cast<std::size_t>(i)] * two_pi * fraction;
    for (int k = 1; k <= loop.cutoff; ++k) {
      const double turns = k * whole_turns;
      const double angle = two_pi * (turns - std::floor(turns));
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      out.cosine(k, i) = loop.cosine(k, i) * c + loop.sine(k, i) * s;
      out.sine(k, i) = loop.sine(k, i) * c - loop.cosine(k, i) * s;
    }
  }
  return out;
}

double mean_distance(const Loop& a, const Loop& b) {
  core::require(a.dimension == b.dimension, "loops of different dimension have no distance");
  core::require(a.winding == b.winding, "loops that wind differently have no distance");
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

double rms_speed(const Loop& loop) {
  const double rate = two_pi / loop.period;
  double sum = 0.0;
  for (int k = loop.cutoff; k >= 1; --k) sum += 0.5 * k * k * harmonic_norm_squared(loop, k);
  return rate * std::sqrt(sum + squared_norm(loop.winding));
}

double rms_amplitude(const Loop& loop) {
  double sum = 0.0;
  for (int k = loop.cutoff; k >= 1; --k) sum += 0.5 * harmonic_norm_squared(loop, k);
  return std::sqrt(sum);
}

double rms_size(const Loop& loop) {
  const double amplitude = rms_amplitude(loop);
  return std::sqrt(squared_norm(row(loop, 0)) + amplitude * amplitude);
}

double tail(const Loop& loop) {
  const int first = loop.cutoff - std::max(2, loop.cutoff / 8) + 1;
  double largest = 0.0;
  for (int k = std::max(1, first); k <= loop.cutoff; ++k)
    largest = std::max(largest, std::sqrt(harmonic_norm_squared(loop, k)));
  return largest;
}

namespace {

bool has_small_odd_factors(int n) {
  for (const int p : {3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

// Greedy: from one allowed 2K + 1 the next is the smallest with ratio >= 1.22 (ratios come out between 1.22 and 1.4).
const std::vector<int>& allowed_cutoffs() {
  static const std::vector<int> table = [] {
    std::vector<int> cutoffs;
    int last = 3;
    cutoffs.push_back(1);
    for (int n = 5; n < 1 << 22; n += 2)
      if (n >= 1.22 * last && has_small_odd_factors(n)) {
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
