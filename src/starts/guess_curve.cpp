#include "orbweaver/starts/guess_curve.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <boost/math/interpolators/makima.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using numerics::two_pi;

/// A step in parts of 1/rate. Of a passage whose derivatives grow as q! rate^q the polynomial between two nodes misses
/// the 64th part of this to the sixth power: 1e-9, as much as a guess's harmonics leave out.
constexpr double turn_a_step = 1.0 / 16.0;
/// By how much the motion may turn in a step that was chosen where it was slower, in those parts.
constexpr double faster_at_end = 2.0;
/// Over how many times 1/rate the rate is smoothed, and how far the smoothing reaches, in these.
constexpr double smoothed_over = 1.0;
constexpr double reach = 5.0;
/// Harmonics of a density that is smoothed so fall like exp(-(k w)^2/2): from this k w on they are rounding.
constexpr double band = 7.0;

struct Motion {
  std::vector<double> slope;
  std::vector<double> bend;
  double rate = 0.0;
};

Motion motion_at(const systems::System& system, const std::vector<double>& state) {
  const std::size_t d = state.size();
  Motion out{std::vector<double>(d), std::vector<double>(d, 0.0)};
  std::vector<double> jacobian(d * d);
  system.field_jacobian(1, state.data(), out.slope.data(), jacobian.data());
  double speed = 0.0;
  double turning = 0.0;
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t l = 0; l < d; ++l) out.bend[i] += jacobian[i * d + l] * out.slope[l];
    speed = std::hypot(speed, out.slope[i]);
    turning = std::hypot(turning, out.bend[i]);
  }
  out.rate = speed > 0.0 ? turning / speed : 0.0;
  if (!std::isfinite(out.rate)) throw core::NotFiniteError("the field along the guess is not finite");
  return out;
}

double step_at(double rate, double longest) { return std::min(longest, turn_a_step / std::max(rate, 1e-300)); }

[[noreturn]] void give_up(double time) {
  throw core::NumericalError(fmt::format("the guess takes more than {} steps, up to t = {:.9g}", most_nodes, time));
}

/// Between two nodes the polynomial that has their states and first two derivatives.
std::vector<double> between(const TrajectoryNode& a, const TrajectoryNode& b, double time) {
  const double h = b.time - a.time;
  const double u = (time - a.time) / h;
  const double v = 1.0 - u;
  const double u3 = u * u * u;
  const double v3 = v * v * v;
  std::vector<double> out(a.state.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = v3 * (a.state[i] * (1.0 + 3.0 * u + 6.0 * u * u) + h * u * (a.slope[i] * (1.0 + 3.0 * u)) +
                   0.5 * h * h * u * u * a.bend[i]) +
             u3 * (b.state[i] * (1.0 + 3.0 * v + 6.0 * v * v) - h * v * (b.slope[i] * (1.0 + 3.0 * v)) +
                   0.5 * h * h * v * v * b.bend[i]);
  return out;
}

double rate_of(const TrajectoryNode& node) {
  double speed = 0.0;
  double turning = 0.0;
  for (std::size_t i = 0; i < node.slope.size(); ++i) {
    speed = std::hypot(speed, node.slope[i]);
    turning = std::hypot(turning, node.bend[i]);
  }
  return speed > 0.0 ? turning / speed : 0.0;
}

/// The integral of the rate from the curve's beginning, by the trapezoidal rule.
std::vector<double> turned(const std::vector<double>& times, const std::vector<double>& rates) {
  std::vector<double> out(times.size(), 0.0);
  for (std::size_t j = 1; j < times.size(); ++j)
    out[j] = out[j - 1] + 0.5 * (times[j] - times[j - 1]) * (rates[j] + rates[j - 1]);
  return out;
}

/// Means of values on a closed mesh with the weight exp(-x^2/2) of the distance x.
std::vector<double> smoothed(const std::vector<double>& at, const std::vector<double>& values) {
  const std::size_t cells = at.size() - 1;  // the last one is the first one again
  const double length = at.back();
  const double within = std::min(reach * smoothed_over, 0.5 * length);
  std::vector<double> out(at.size());
  for (std::size_t j = 0; j < cells; ++j) {
    double sum = 0.0;
    double weights = 0.0;
    for (const int side : {1, -1})
      for (std::size_t n = side > 0 ? 0 : 1; n < cells; ++n) {
        const std::size_t m = side > 0 ? (j + n) % cells : (j + cells - n) % cells;
        double away = side * (at[m] - at[j]);
        if (away < 0.0) away += length;
        if (away > within) break;
        const double width = at[m + 1] - at[m] + (m > 0 ? at[m] - at[m - 1] : at[cells] - at[cells - 1]);
        const double weight = width * std::exp(-0.5 * std::pow(away / smoothed_over, 2));
        sum += weight * values[m];
        weights += weight;
      }
    out[j] = sum / weights;
  }
  out.back() = out.front();
  return out;
}

}  // namespace

GuessCurve::Fastest GuessCurve::fastest() const {
  const auto at = std::max_element(rates.begin(), rates.end());
  return {times[static_cast<std::size_t>(at - rates.begin())], *at};
}

std::vector<TrajectoryNode> trajectory_nodes(const systems::System& system, const Advance& advance,
                                             const std::vector<double>& state, double time, double longest) {
  Motion here = motion_at(system, state);
  std::vector<TrajectoryNode> nodes{{0.0, state, here.slope, here.bend}};
  double remaining = std::abs(time);
  double step = step_at(here.rate, longest);
  while (remaining > 0.0) {
    core::interruption_point();
    // Of the last two steps neither is short.
    double length = remaining <= step ? remaining : std::min(step, 0.5 * remaining);
    std::vector<double> next;
    Motion there;
    for (;; length *= 0.5) {
      next = advance(nodes.back().state, std::copysign(length, time));
      there = motion_at(system, next);
      if (length * there.rate <= faster_at_end * turn_a_step) break;
    }
    remaining = length == remaining ? 0.0 : remaining - length;
    nodes.push_back({std::copysign(std::abs(time) - remaining, time), std::move(next), there.slope, there.bend});
    if (nodes.size() > most_nodes) give_up(nodes.back().time * system.scales().time);
    step = step_at(there.rate, longest);
  }
  return nodes;
}

GuessCurve curve_through(std::vector<TrajectoryNode> nodes) {
  core::require(nodes.size() > 1, "a curve takes two nodes");
  const double begin = nodes.front().time;
  GuessCurve out;
  for (TrajectoryNode& node : nodes) {
    node.time -= begin;
    out.times.push_back(node.time);
    out.rates.push_back(rate_of(node));
  }
  out.period = out.times.back();
  out.state = [nodes = std::make_shared<const std::vector<TrajectoryNode>>(std::move(nodes))](double time) {
    const auto behind = std::upper_bound(nodes->begin() + 1, nodes->end() - 1, time,
                                         [](double value, const TrajectoryNode& node) { return value < node.time; });
    return between(*(behind - 1), *behind, time);
  };
  return out;
}

GuessCurve curve_of(const systems::System& system, std::function<std::vector<double>(double time)> state, double period,
                    double longest) {
  GuessCurve out;
  out.period = period;
  out.state = std::move(state);
  out.times = {0.0};
  out.rates = {motion_at(system, out.state(0.0)).rate};
  while (out.times.back() < period) {
    core::interruption_point();
    const double remaining = period - out.times.back();
    double length = std::min(step_at(out.rates.back(), longest), remaining);
    double rate = 0.0;
    for (;; length *= 0.5) {
      rate = motion_at(system, out.state(out.times.back() + length)).rate;
      if (length * rate <= faster_at_end * turn_a_step) break;
    }
    if (out.times.size() == most_nodes || out.times.back() + length == out.times.back())
      give_up(out.times.back() * system.scales().time);
    out.times.push_back(length == remaining ? period : out.times.back() + length);
    out.rates.push_back(rate);
  }
  return out;
}

loop::TimeMap map_to_motion(const GuessCurve& curve) {
  std::vector<double> rates = curve.rates;
  for (double& rate : rates) rate = std::hypot(rate, two_pi / curve.period);  // where nothing turns time runs
  const std::vector<double> at = turned(curve.times, rates);
  for (double& rate : rates) rate = std::log(rate);
  std::vector<double> smooth = smoothed(at, rates);
  for (double& rate : smooth) rate = std::exp(rate);
  std::vector<double> s = turned(curve.times, smooth);
  const double length = s.back();
  // One cell more to each side, for the slopes at the ends.
  std::vector<double> places;
  std::vector<double> logs;
  const std::size_t cells = s.size() - 1;
  const std::size_t beside = std::min<std::size_t>(4, cells);
  for (std::size_t j = cells - beside; j < cells; ++j) {
    places.push_back(s[j] - length);
    logs.push_back(-std::log(smooth[j]));
  }
  for (std::size_t j = 0; j <= cells + beside; ++j) {
    places.push_back(s[j % cells] + (j < cells ? 0.0 : length));
    logs.push_back(-std::log(smooth[j % cells]));
  }
  const boost::math::interpolators::makima<std::vector<double>> spline(std::move(places), std::move(logs));
  const int nodes = loop::FourierGrid::nodes_at_least(static_cast<int>(2 * cells));
  std::vector<double> density;
  for (int j = 0; j < nodes; ++j) density.push_back(std::exp(spline(length * j / nodes)));
  return loop::map_of_density(std::move(density), static_cast<int>(band * length / (two_pi * smoothed_over)) + 1);
}

}  // namespace orbweaver::starts
