#include "page/thinned_loop.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"

namespace orbweaver::report {

namespace {

/// A coordinate that moves less, in parts of the one that moves most, is drawn as if it moved that much.
constexpr double least_range = 1e-4;

class Bytes {
 public:
  explicit Bytes(std::vector<std::uint8_t>& bytes) : _bytes(bytes) {}

  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) _bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
  void add_count(std::uint64_t count) {
    for (; count >= 128; count >>= 7) _bytes.push_back(static_cast<std::uint8_t>(count | 128));
    _bytes.push_back(static_cast<std::uint8_t>(count));
  }
  void add_signed(std::int64_t value) {
    add_count((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }

 private:
  std::vector<std::uint8_t>& _bytes;
};

/// One periodic function of s: `modes` a_0, a_1, b_1, ... Returns the harmonics kept.
int add_channel(Bytes& bytes, const std::vector<double>& modes, double allowed) {
  const double half = allowed / 2;
  int kept = static_cast<int>(modes.size() - 1) / 2;
  const auto at = [&](int k) { return modes.begin() + (2 * k - 1); };
  for (double left_out = 0.0; kept > 0; --kept) {
    left_out += std::hypot(*at(kept), *(at(kept) + 1));
    if (left_out > half) break;
  }
  // 2 kept numbers, each off by half a step at most.
  const double step = half / std::max(1, kept);
  bytes.add(step);
  bytes.add(modes.front());
  bytes.add_count(static_cast<std::uint64_t>(kept));
  for (auto mode = modes.begin() + 1; mode < modes.begin() + (2 * kept + 1); ++mode)
    bytes.add_signed(std::llround(*mode / step));
  return kept;
}

/// t/T - s/(2 pi).
std::vector<double> time_modes(const loop::Loop& loop) {
  if (loop.time_map.is_identity()) return {0.0};
  const int nodes = loop::nodes_for(loop);
  std::vector<double> values(static_cast<std::size_t>(nodes));
  for (int j = 0; j < nodes; ++j) {
    const double s = 2 * std::numbers::pi * j / nodes;
    values[static_cast<std::size_t>(j)] = (loop.time_map.phase(s) - s) / (2 * std::numbers::pi);
  }
  const int cutoff = nodes / 2 - 1;
  std::vector<double> modes(static_cast<std::size_t>(2 * cutoff + 1));
  loop::FourierGrid::of_size(nodes).analyze(cutoff, 1, values.data(), modes.data());
  return modes;
}

std::vector<double> modes_of(const loop::Loop& loop, int coordinate) {
  std::vector<double> modes;
  for (auto at = static_cast<std::size_t>(coordinate); at < loop.modes.size();
       at += static_cast<std::size_t>(loop.dimension))
    modes.push_back(loop.modes[at]);
  return modes;
}

/// The largest of equidistant values of a periodic function, by the parabola through it and its neighbours.
double largest_of(const double* values, int nodes) {
  const auto top = static_cast<int>(std::max_element(values, values + nodes) - values);
  const double before = values[(top + nodes - 1) % nodes];
  const double after = values[(top + 1) % nodes];
  const double bend = before - 2 * values[top] + after;
  return bend < 0.0 ? values[top] - (after - before) * (after - before) / (8 * bend) : values[top];
}

}  // namespace

std::uint8_t spectrum_byte(double modulus) {
  constexpr double least = -20.0;
  constexpr double per_decade = 10.0;
  if (!(modulus > 0.0)) return 0;
  return static_cast<std::uint8_t>(std::clamp(std::round((std::log10(modulus) - least) * per_decade), 0.0, 255.0));
}

ThinnedLoop thinned(const loop::Loop& loop, double tolerance) {
  const loop::Samples samples = loop::samples_of(loop);
  const auto dimension = static_cast<std::size_t>(loop.dimension);
  ThinnedLoop result;
  result.amplitude = loop::rms_amplitude(loop);
  std::vector<double> ranges;
  for (std::size_t i = 0; i < dimension; ++i) {
    const double* values = samples.states.data() + i * static_cast<std::size_t>(samples.nodes);
    const auto [low, high] = std::minmax_element(values, values + samples.nodes);
    const bool winds = loop.winding[i] != 0.0;
    ranges.push_back(winds ? std::abs(loop.winding[i]) * 2 * std::numbers::pi : *high - *low);
    result.largest.push_back(winds ? std::numeric_limits<double>::quiet_NaN() : largest_of(values, samples.nodes));
  }
  double widest = *std::max_element(ranges.begin(), ranges.end());
  if (widest == 0.0) widest = 1.0;  // a constant loop
  Bytes bytes(result.bytes);
  add_channel(bytes, time_modes(loop), tolerance);
  for (std::size_t i = 0; i < dimension; ++i) {
    const double range = std::max(ranges[i], least_range * widest);
    result.harmonics =
        std::max(result.harmonics, add_channel(bytes, modes_of(loop, static_cast<int>(i)), tolerance * range));
  }
  const int width = (loop.cutoff + most_bins - 1) / most_bins;
  const int bins = (loop.cutoff + width - 1) / width;
  bytes.add_count(static_cast<std::uint64_t>(bins));
  bytes.add_count(static_cast<std::uint64_t>(width));
  for (int i = 0; i < loop.dimension; ++i)
    for (int bin = 0; bin < bins; ++bin) {
      double most = 0.0;
      for (int k = 1 + bin * width; k <= std::min(loop.cutoff, (bin + 1) * width); ++k)
        most = std::max(most, std::hypot(loop.cosine(k, i), loop.sine(k, i)));
      result.bytes.push_back(spectrum_byte(most));
    }
  return result;
}

}  // namespace orbweaver::report
