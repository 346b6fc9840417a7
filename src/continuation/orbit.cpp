#include "orbweaver/continuation/orbit.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"

namespace orbweaver::continuation {

double energy_of(const systems::System& system, const loop::Loop& loop) {
  if (!system.structure().conservative()) return std::numeric_limits<double>::quiet_NaN();
  return loop::system_at(system, loop)->conserved(0, loop::state_at(loop, 0.0));
}

double level_of(const systems::System& system, const loop::Loop& loop) {
  return system.family_scalars().free.empty() ? energy_of(system, loop) : loop.parameters.front();
}

double action_of(const systems::System& system, const loop::Loop& loop) {
  const std::shared_ptr<const systems::System> here = loop::system_at(system, loop);
  const loop::Samples samples = loop::samples_of(loop);
  const auto n = static_cast<std::size_t>(samples.nodes);
  std::vector<double> state(static_cast<std::size_t>(loop.dimension));
  double sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] = samples.states[i * n + j];
    sum += samples.weights[j] * here->action_density(state);
  }
  return loop.period * sum;
}

namespace {

/// What harmonics in time may leave out of a distance between orbits: a closed family is told by steps, a closed locus
/// by 1e-6 of its length.
constexpr double left_out = 1e-10;
/// Roundings of the coordinates by which two computations of one orbit may differ. Not measured.
constexpr double roundings = 1e3;

double with_scalars(double distance, const loop::Loop& from, const loop::Loop& to) {
  core::require(from.parameters.size() == to.parameters.size(), "a distance between loops of different families");
  double parameters = 0.0;
  for (std::size_t n = 0; n < from.parameters.size(); ++n)
    parameters = std::hypot(parameters, to.parameters[n] - from.parameters[n]);
  return std::hypot(distance, (to.period - from.period) / from.period, parameters);
}

}  // namespace

double arclength_between(const loop::Loop& from, const loop::Loop& to) {
  return with_scalars(loop::mean_distance(from, to), from, to);
}

double distance_between_orbits(const systems::System& system, const loop::Loop& from, const loop::Loop& to) {
  const std::vector<int>& angles = system.structure().angles;
  const loop::Loop y = loop::evenly_in_time(from, left_out);
  const loop::Loop x = loop::evenly_in_time(to, left_out);
  double least = std::numeric_limits<double>::infinity();
  for (const loop::ShiftMinimum& minimum : loop::shift_minima(y, x, angles))
    least = std::min(least, loop::rms_size(loop::difference_at(y, x, angles, minimum.shift)));
  return with_scalars(least, from, to);
}

double same_within(const loop::Loop& loop, double tolerance) {
  return std::max(tolerance * (1.0 + loop::rms_amplitude(loop)),
                  roundings * std::numeric_limits<double>::epsilon() * loop::rms_size(loop));
}

double arclength_in_units(const systems::System& system, const loop::Loop& from, const loop::Loop& to) {
  return arclength_between(loop::in_units(from, system.scales()), loop::in_units(to, system.scales()));
}

}  // namespace orbweaver::continuation
