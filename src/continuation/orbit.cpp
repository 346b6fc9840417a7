#include "orbweaver/continuation/orbit.hpp"

#include <cmath>
#include <vector>

#include "orbweaver/loop/fourier.hpp"

namespace orbweaver::continuation {

double energy_of(const systems::System& system, const loop::Loop& loop) {
  return system.energy(loop::state_at(loop, 0.0));
}

double action_of(const systems::System& system, const loop::Loop& loop) {
  const int nodes = loop::FourierGrid::nodes_for(loop.cutoff);
  const auto n = static_cast<std::size_t>(nodes);
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> nodal(d * n);
  loop::FourierGrid::of_size(nodes).synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.data());
  std::vector<double> state(d);
  double sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < d; ++i)
      state[i] = nodal[i * n + j] + loop.winding[i] * 2.0 * M_PI * static_cast<double>(j) / nodes;
    sum += system.action_density(state);
  }
  return loop.period * sum / nodes;
}

double arclength_between(const loop::Loop& from, const loop::Loop& to) {
  return std::hypot(loop::mean_distance(from, to), (to.period - from.period) / from.period);
}

}  // namespace orbweaver::continuation
