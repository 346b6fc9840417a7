#include "orbweaver/loop/curve/passages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

/// Cells a wave of the highest harmonic, over which a trigonometric polynomial has at most one extremum but for
/// near-cancellations.
constexpr int cells_a_wave = 8;
/// Of the loop's amplitude: a coordinate that stays so near to the value rests there, as in an invariant plane.
constexpr double at_rest = 1e-12;
/// Of s, to rounding.
constexpr double of_parameter = 1e-15;
/// Of the period: a passage at s = 0 stays there whatever its rounding.
constexpr double at_start = 1e-12;

/// One coordinate against s.
Loop part_of(const Loop& loop, int coordinate) {
  Loop out = constant_loop(std::vector{loop.cosine(0, coordinate)}, two_pi, loop.cutoff);
  out.winding[0] = loop.winding[static_cast<std::size_t>(coordinate)];
  for (int k = 1; k <= loop.cutoff; ++k) {
    out.cosine(k, 0) = loop.cosine(k, coordinate);
    out.sine(k, 0) = loop.sine(k, coordinate);
  }
  return out;
}

Loop derivative_of(const Loop& part) {
  Loop out = part;
  out.winding[0] = 0.0;
  out.cosine(0, 0) = part.winding[0];
  for (int k = 1; k <= part.cutoff; ++k) {
    out.cosine(k, 0) = k * part.sine(k, 0);
    out.sine(k, 0) = -k * part.cosine(k, 0);
  }
  return out;
}

std::vector<double> nodal(const Loop& part, int nodes) {
  std::vector<double> out(static_cast<std::size_t>(nodes) + 1);
  FourierGrid::of_size(nodes).synthesize(part.cutoff, 1, part.modes.data(), out.data());
  for (int j = 0; j < nodes; ++j) out[static_cast<std::size_t>(j)] += part.winding[0] * two_pi * j / nodes;
  out.back() = out.front() + two_pi * part.winding[0];
  return out;
}

/// Zeros of it are the passages.
struct Distance {
  double value;
  bool is_angle;
  [[nodiscard]] double operator()(double coordinate) const {
    return is_angle ? 2.0 * std::sin(0.5 * (coordinate - value)) : coordinate - value;
  }
  /// Its derivative, of a coordinate with this slope.
  [[nodiscard]] double slope(double coordinate, double coordinate_slope) const {
    return is_angle ? std::cos(0.5 * (coordinate - value)) * coordinate_slope : coordinate_slope;
  }
};

}  // namespace

std::vector<double> passages(const Loop& loop, int coordinate, double value, bool is_angle) {
  core::require(coordinate >= 0 && coordinate < loop.dimension, "passages are of one of the loop's coordinates");
  const Loop part = part_of(loop, coordinate);
  const Loop derivative = derivative_of(part);
  const Distance distance{value, is_angle};
  const auto at = [&](double s) { return distance(state_at(part, s)[0]); };
  const auto slope_at = [&](double s) { return distance.slope(state_at(part, s)[0], state_at(derivative, s)[0]); };
  const int nodes = cells_a_wave * (loop.cutoff + 1);
  std::vector<double> values = nodal(part, nodes);
  std::vector<double> slopes = nodal(derivative, nodes);
  double largest = 0.0;
  for (std::size_t j = 0; j < values.size(); ++j) {
    slopes[j] = distance.slope(values[j], slopes[j]);
    values[j] = distance(values[j]);
    largest = std::max(largest, std::abs(values[j]));
  }
  if (largest <= at_rest * rms_amplitude(loop)) return {};

  std::vector<double> times;
  const auto add = [&](const numerics::Place& from, const numerics::Place& to) {
    const auto root = numerics::locate_root(at, from, to, of_parameter * two_pi);
    if (!root) return;
    const double time = loop.period * loop.time_map.phase(root->position) / two_pi;
    const bool is_start = std::min(std::abs(time), std::abs(time - loop.period)) < at_start * loop.period;
    times.push_back(is_start ? 0.0 : time);
  };
  // At a node that is a zero the sign is that just after it.
  const auto sign = [&](std::size_t j) { return values[j] != 0.0 ? values[j] > 0.0 : slopes[j] > 0.0; };
  for (std::size_t j = 0; j + 1 < values.size(); ++j) {
    const double s = two_pi * static_cast<double>(j) / nodes;
    const double next = two_pi * static_cast<double>(j + 1) / nodes;
    // The values that decided: another way of summing may round to the other sign.
    const numerics::Place from{s, values[j]};
    const numerics::Place to{next, values[j + 1]};
    if (sign(j) != sign(j + 1)) {
      add(from, to);
    } else if (values[j] * slopes[j] < 0.0 && values[j + 1] * slopes[j + 1] > 0.0) {
      const auto extremum =
          numerics::locate_root(slope_at, {s, slopes[j]}, {next, slopes[j + 1]}, of_parameter * two_pi);
      if (!extremum) continue;
      const numerics::Place between{extremum->position, at(extremum->position)};
      if (between.value * values[j] >= 0.0) continue;
      add(from, between);
      add(between, to);
    }
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace orbweaver::loop
