#include "orbweaver/starts/loop_guess.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <boost/math/interpolators/makima.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using numerics::two_pi;

/// States that a spline is evaluated at.
constexpr std::size_t samples_of_spline = 4 * static_cast<std::size_t>(loop::time_sample_count);
/// Of a guess's harmonics, relative to its size: smaller ones are left out.
constexpr double left_out = 1e-9;
/// And those that are this part of what the trajectory misses itself by: its kink has harmonics without end, which no
/// orbit near it has. Kept, they take many steps of a branch to go.
constexpr double left_out_of_gap = 1e-3;
/// Of the period: a state so near to a whole one after the first closes the loop (decimal digits of a table).
constexpr double same_time = 1e-6;
/// Neighbours that a spline's slopes are made from, to each side.
constexpr std::size_t neighbours = 3;

}  // namespace

loop::Loop loop_through(const systems::Structure& structure, std::vector<std::vector<double>> states, double period) {
  core::require(states.size() > 4, "a loop takes four states and the one at which it closes");
  const std::size_t d = states.front().size();
  const std::size_t count = states.size() - 1;
  loop::TimeSamples samples;
  samples.dimension = static_cast<int>(d);
  samples.count = static_cast<int>(count);
  samples.period = period;
  samples.states.resize(d * count);
  samples.winding.assign(d, 0.0);
  double missed = 0.0;
  for (std::size_t i = 0; i < d; ++i) {
    const double gap = states[count][i] - states[0][i];
    if (structure.is_angle(i)) samples.winding[i] = std::round(gap / two_pi);
    missed = std::hypot(missed, gap - two_pi * samples.winding[i]);
    for (std::size_t j = 0; j < count; ++j)
      samples.states[i * count + j] = states[j][i] - static_cast<double>(j) / static_cast<double>(count) * gap;
  }
  loop::Loop out = loop::interpolant(samples);
  const double allowed = std::max(left_out * loop::rms_amplitude(out), left_out_of_gap * missed);
  int cutoff = out.cutoff;
  while (loop::previous_cutoff(cutoff) < cutoff &&
         loop::mean_distance(out, loop::with_cutoff(out, loop::previous_cutoff(cutoff))) < allowed)
    cutoff = loop::previous_cutoff(cutoff);
  return loop::with_cutoff(out, loop::allowed_cutoff_at_least(cutoff));
}

loop::Loop loop_through(const systems::Structure& structure, const std::vector<double>& times,
                        std::vector<std::vector<double>> states, double period) {
  core::require(times.size() == states.size() && times.size() > neighbours, "a spline takes four states at least");
  const std::size_t d = states.front().size();
  // An angle runs on from one to the next.
  const auto next_to = [&](double value, double before, std::size_t i) {
    return structure.is_angle(i) ? before + std::remainder(value - before, two_pi) : value;
  };
  for (std::size_t j = 1; j < states.size(); ++j)
    for (std::size_t i = 0; i < d; ++i) states[j][i] = next_to(states[j][i], states[j - 1][i], i);
  std::vector<double> nodes = times;
  std::vector<double> closing(d);
  if (std::abs(nodes.back() - nodes.front() - period) <= same_time * period && states.size() > neighbours + 1) {
    closing = std::move(states.back());
    states.pop_back();
    nodes.pop_back();
  } else {
    for (std::size_t i = 0; i < d; ++i) closing[i] = next_to(states.front()[i], states.back()[i], i);
  }
  std::vector<std::vector<double>> even(samples_of_spline + 1, std::vector<double>(d));
  for (std::size_t i = 0; i < d; ++i) {
    const double gap = closing[i] - states.front()[i];
    std::vector<double> x, y;
    const std::size_t count = nodes.size();
    for (std::size_t j = 0; j < count + 2 * neighbours; ++j) {  // before the first, around, behind the last
      const double around = j < neighbours ? -1.0 : j < count + neighbours ? 0.0 : 1.0;
      const std::size_t at = (j + count - neighbours) % count;
      x.push_back(nodes[at] + around * period);
      y.push_back(states[at][i] + around * gap);
    }
    const boost::math::interpolators::makima<std::vector<double>> spline(std::move(x), std::move(y));
    for (std::size_t j = 0; j <= samples_of_spline; ++j)
      even[j][i] = spline(nodes.front() + period * static_cast<double>(j) / static_cast<double>(samples_of_spline));
  }
  return loop_through(structure, std::move(even), period);
}

}  // namespace orbweaver::starts
