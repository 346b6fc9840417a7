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

/// A periodic function of s as whole numbers times a step.
struct Channel {
  double step = 0.0;
  double mean = 0.0;
  std::vector<std::int64_t> numbers;  ///< a_1, b_1, a_2, ...
};

/// The harmonics whose sum of squares is more than `left_out` squared, halved for the mean over s, and the rest rounded
/// so that the same is true of what that changes.
Channel rounded(const std::vector<double>& modes, double left_out) {
  auto kept = (modes.size() - 1) / 2;
  double dropped = 0.0;
  for (; kept > 0; --kept) {
    const double a = modes[2 * kept - 1];
    const double b = modes[2 * kept];
    dropped += (a * a + b * b) / 2;
    if (dropped > left_out * left_out) break;
  }
  Channel channel;
  channel.mean = modes.front();
  channel.step = left_out * std::sqrt(12.0 / static_cast<double>(std::max<std::size_t>(1, kept)));  // of equal chances
  for (std::size_t at = 1; at <= 2 * kept; ++at) channel.numbers.push_back(std::llround(modes[at] / channel.step));
  return channel;
}

std::vector<double> synthesized(const std::vector<double>& modes, int nodes) {
  std::vector<double> values(static_cast<std::size_t>(nodes));
  const int cutoff = static_cast<int>(modes.size() - 1) / 2;
  loop::FourierGrid::of_size(nodes).synthesize(cutoff, 1, modes.data(), values.data());
  return values;
}

double largest_difference(const std::vector<double>& modes, const Channel& channel, int nodes) {
  std::vector<double> difference = modes;
  difference.front() = 0.0;
  for (std::size_t i = 0; i < channel.numbers.size(); ++i)
    difference[i + 1] -= static_cast<double>(channel.numbers[i]) * channel.step;
  double largest = 0.0;
  for (const double value : synthesized(difference, nodes)) largest = std::max(largest, std::abs(value));
  return largest;
}

struct Added {
  int harmonics = 0;
  double deviation = 0.0;
};

/// One periodic function of s, within `allowed` of `modes` (a_0, a_1, b_1, ...) at the nodes.
Added add_channel(Bytes& bytes, const std::vector<double>& modes, double allowed, int nodes) {
  // The largest value of what is left out is some three times its rms; where it is more, there is another attempt.
  double left_out = allowed / 4;
  Channel channel = rounded(modes, left_out);
  double deviation = largest_difference(modes, channel, nodes);
  while (deviation > allowed) {
    left_out *= 0.75;
    channel = rounded(modes, left_out);
    deviation = largest_difference(modes, channel, nodes);
  }
  bytes.add(channel.step);
  bytes.add(channel.mean);
  bytes.add_count(channel.numbers.size() / 2);
  for (const std::int64_t number : channel.numbers) bytes.add_signed(number);
  return {static_cast<int>(channel.numbers.size() / 2), deviation};
}

/// t/T - s/(2 pi).
std::vector<double> time_modes(const loop::Loop& loop, int nodes) {
  if (loop.time_map.is_identity()) return {0.0};
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
  result.deviation = add_channel(bytes, time_modes(loop, samples.nodes), tolerance, samples.nodes).deviation;
  for (std::size_t i = 0; i < dimension; ++i) {
    const double range = std::max(ranges[i], least_range * widest);
    const Added added = add_channel(bytes, modes_of(loop, static_cast<int>(i)), tolerance * range, samples.nodes);
    result.harmonics = std::max(result.harmonics, added.harmonics);
    result.deviation = std::max(result.deviation, added.deviation / range);
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
