#include "orbweaver/starts/loop_guess.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <boost/math/interpolators/makima.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using numerics::two_pi;

/// Samples, even in time, of a curve: where they resolve it, the branch finds its own time map.
constexpr int samples_of_guess = 4 * loop::time_sample_count;
/// Of a guess's harmonics, relative to its size: smaller ones are left out.
constexpr double left_out = 1e-9;
/// And those that are this part of what the trajectory misses itself by: its kink has harmonics without end, which no
/// orbit near it has. Kept, they take many steps of a branch to go.
constexpr double left_out_of_gap = 1e-3;
/// Of the period: a state so near to a whole one after the first closes the loop (decimal digits of a table).
constexpr double same_time = 1e-6;
/// Neighbours that a spline's slopes are made from, to each side.
constexpr std::size_t neighbours = 3;

/// A loop with all harmonics that its samples have, and what a guess leaves out of them.
struct Sampled {
  loop::Loop loop;
  double left_out = 0.0;

  [[nodiscard]] bool is_resolved() const { return loop::tail(loop) <= left_out; }
  /// Without the harmonics that are left out.
  [[nodiscard]] loop::Loop shortened() const {
    int cutoff = loop.cutoff;
    while (loop::previous_cutoff(cutoff) < cutoff &&
           loop::mean_distance(loop, loop::with_cutoff(loop, loop::previous_cutoff(cutoff))) < left_out)
      cutoff = loop::previous_cutoff(cutoff);
    return loop::with_cutoff(loop, loop::allowed_cutoff_at_least(cutoff));
  }
};

/// From states at equidistant s, the last one where the loop closes.
Sampled sampled(const systems::Structure& structure, const std::vector<std::vector<double>>& states, double period,
                const loop::TimeMap& map) {
  const std::size_t d = states.front().size();
  const std::size_t count = states.size() - 1;
  loop::TimeSamples samples;
  samples.dimension = static_cast<int>(d);
  samples.count = static_cast<int>(count);
  samples.period = period;
  samples.states.resize(d * count);
  samples.winding.assign(d, 0.0);
  std::vector<double> s;
  for (std::size_t j = 0; j < count; ++j) s.push_back(two_pi * static_cast<double>(j) / static_cast<double>(count));
  const std::vector<double> phases = map.phases(s);
  double missed = 0.0;
  for (std::size_t i = 0; i < d; ++i) {
    const double gap = states[count][i] - states[0][i];
    if (structure.is_angle(i)) samples.winding[i] = std::round(gap / two_pi);
    missed = std::hypot(missed, gap - two_pi * samples.winding[i]);
    for (std::size_t j = 0; j < count; ++j)
      samples.states[i * count + j] =
          states[j][i] - phases[j] / two_pi * (gap - two_pi * samples.winding[i]) - samples.winding[i] * s[j];
  }
  Sampled out{loop::interpolant(samples)};
  out.loop.time_map = map;
  out.left_out = std::max(left_out * loop::rms_amplitude(out.loop), left_out_of_gap * missed);
  return out;
}

/// At so many times of a curve as s runs under the map.
Sampled sampled(const systems::Structure& structure, const GuessCurve& curve, const loop::TimeMap& map, int count) {
  std::vector<double> s;
  for (int j = 0; j < count; ++j) s.push_back(two_pi * j / count);
  std::vector<std::vector<double>> states;
  for (const double phase : map.phases(s)) states.push_back(curve.state(curve.period * phase / two_pi));
  states.push_back(curve.state(curve.period));
  return sampled(structure, states, curve.period, map);
}

}  // namespace

loop::Loop loop_through(const systems::Structure& structure, const std::vector<std::vector<double>>& states,
                        double period) {
  core::require(states.size() > 4, "a loop takes four states and the one at which it closes");
  return sampled(structure, states, period, {}).shortened();
}

loop::Loop loop_through(const systems::Structure& structure, const GuessCurve& curve) {
  Sampled out = sampled(structure, curve, {}, samples_of_guess);
  if (out.is_resolved()) return out.shortened();
  const loop::TimeMap map = map_to_motion(curve);
  int count = loop::FourierGrid::nodes_at_least(std::max(samples_of_guess, static_cast<int>(curve.times.size())));
  do {
    out = sampled(structure, curve, map, count);
    count = loop::FourierGrid::nodes_at_least(2 * count);
  } while (!out.is_resolved() && count <= static_cast<int>(most_nodes));
  return out.shortened();
}

GuessCurve curve_through(const systems::System& system, const std::vector<double>& times,
                         std::vector<std::vector<double>> states, double period) {
  const systems::Structure& structure = system.structure();
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
  using Spline = boost::math::interpolators::makima<std::vector<double>>;
  auto splines = std::make_shared<std::vector<Spline>>();
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
    splines->emplace_back(std::move(x), std::move(y));
  }
  const auto state = [splines, begin = nodes.front()](double time) {
    std::vector<double> out;
    for (const Spline& spline : *splines) out.push_back(spline(begin + time));
    return out;
  };
  try {
    return curve_of(system, state, period, period / loop::time_sample_count);
  } catch (const core::NumericalError& error) {
    throw core::InputError(
        fmt::format("expected states between which the field can be followed, got: {}", error.what()));
  }
}

}  // namespace orbweaver::starts
