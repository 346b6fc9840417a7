#include "least_guard.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::continuation {

namespace {

/// Of the distance between nodes, for the place of a minimum: its value is then right to the square of that.
constexpr double least_place_tolerance = 1e-8;

/// z(s), windings included.
std::vector<double> state_at_parameter(const loop::Loop& loop, double s) {
  const auto dimension = static_cast<std::size_t>(loop.dimension);
  std::vector<double> z(loop.modes.begin(), loop.modes.begin() + loop.dimension);
  for (std::size_t i = 0; i < dimension; ++i) z[i] += loop.winding[i] * s;
  for (int k = 1; k <= loop.cutoff; ++k) {
    const double cosine = std::cos(k * s);
    const double sine = std::sin(k * s);
    for (int i = 0; i < loop.dimension; ++i)
      z[static_cast<std::size_t>(i)] += loop.cosine(k, i) * cosine + loop.sine(k, i) * sine;
  }
  return z;
}

}  // namespace

std::vector<double> guard_at(const systems::System& system, int guard, const loop::Samples& samples) {
  core::require(guard >= 0 && guard < static_cast<int>(system.structure().guards.size()),
                "the structure names no such guard");
  const auto nodes = static_cast<std::size_t>(samples.nodes);
  std::vector<double> values(nodes);
  std::vector<double> z(static_cast<std::size_t>(system.dimension()));
  for (std::size_t j = 0; j < nodes; ++j) {
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = samples.states[i * nodes + j];
    values[j] = system.guard(guard, z);
  }
  return values;
}

double least_guard(const systems::System& family, int guard, const loop::Loop& loop) {
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const std::vector<double> values = guard_at(system, guard, loop::samples_of(loop));
  const std::size_t nodes = values.size();
  double least = *std::min_element(values.begin(), values.end());
  const double lowest_node = least;
  const double spacing = 2.0 * std::numbers::pi / static_cast<double>(nodes);
  for (std::size_t j = 0; j < nodes; ++j) {
    const double before = values[(j + nodes - 1) % nodes];
    const double after = values[(j + 1) % nodes];
    if (!(values[j] <= before && values[j] <= after)) continue;
    // Below a node a minimum lies by less than its neighbours above (a parabola: by an eighth of their difference).
    if (2.0 * values[j] - std::max(before, after) > lowest_node) continue;
    const double s = spacing * static_cast<double>(j);
    const auto minimum =
        numerics::locate_minimum([&](double at) { return system.guard(guard, state_at_parameter(loop, at)); },
                                 s - spacing, s + spacing, least_place_tolerance * spacing);
    if (minimum) least = std::min(least, minimum->value);
  }
  return least;
}

}  // namespace orbweaver::continuation
