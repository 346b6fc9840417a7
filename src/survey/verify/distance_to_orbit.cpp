#include "verify/distance_to_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace orbweaver::survey {

namespace {

/// Stretches of the orbit where the nearest state may be, and halvings of them: to rounding.
constexpr std::size_t nearest_nodes = 6;
constexpr int golden_sections = 80;

template <class Gap>
double least_between(const Gap& gap, double from, double to) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double least = std::min(gap(from), gap(to));
  for (int n = 0; n < golden_sections; ++n) {
    const double a = to - golden * (to - from);
    const double b = from + golden * (to - from);
    const double at_a = gap(a);
    const double at_b = gap(b);
    least = std::min({least, at_a, at_b});
    (at_a < at_b ? to : from) = at_a < at_b ? b : a;
  }
  return least;
}

}  // namespace

double distance_to_orbit(const systems::Structure& system, const loop::Loop& loop, const std::vector<double>& state) {
  const auto gap = [&](double time) {
    const std::vector<double> z = loop::state_at(loop, time);
    double sum = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      double off = z[i] - state[i];
      if (system.is_angle(i)) off = std::remainder(off, 2.0 * std::numbers::pi);
      sum += off * off;
    }
    return std::sqrt(sum);
  };
  // Golden sections beside the nodes, even in s, that are nearer than their neighbours: the nearest ones.
  const int nodes = 4 * loop.cutoff + 8;
  std::vector<double> times;
  std::vector<double> gaps;
  for (int j = 0; j <= nodes; ++j) {
    times.push_back(loop.period * loop.time_map.phase(2.0 * std::numbers::pi * j / nodes) / (2.0 * std::numbers::pi));
    gaps.push_back(gap(times.back()));
  }
  std::vector<std::size_t> minima;
  for (std::size_t j = 0; j < gaps.size(); ++j)
    if ((j == 0 || gaps[j] <= gaps[j - 1]) && (j + 1 == gaps.size() || gaps[j] <= gaps[j + 1])) minima.push_back(j);
  std::sort(minima.begin(), minima.end(), [&](std::size_t a, std::size_t b) { return gaps[a] < gaps[b]; });
  minima.resize(std::min(minima.size(), nearest_nodes));
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t j : minima)
    least = std::min(least, least_between(gap, times[j > 0 ? j - 1 : 0], times[std::min(j + 1, times.size() - 1)]));
  return least;
}

}  // namespace orbweaver::survey
