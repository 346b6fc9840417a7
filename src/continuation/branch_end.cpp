#include "branch_end.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace orbweaver::continuation {

namespace {

/// Orbits after which a branch may have come back or to a fixed point: the first ones lie near the start anyway.
constexpr int first_orbits = 3;
/// The end at a fixed point, of the first orbit's amplitude and the start's: steps there are of the amplitude's size.
constexpr double vanishing_amplitude = 0.5;
/// How near the first orbit must be, in parts of the last step: the step that comes next would pass it.
constexpr double closing = 0.5;
/// A branch has come back only after it was so much further away. Not measured; it must only tell these two apart.
constexpr double was_away = 0.25;
/// How often the period must have grown, and how little of its range the energy may have moved over `period_window`,
/// where the period diverges. Not measured; both decide only how an end is called.
constexpr double grown_period = 2.0;
constexpr double settled_energy = 1e-3;

}  // namespace

std::optional<Ending> end_at(const Frontier& frontier, const Options& options, const systems::Scales& units) {
  const Orbit& orbit = frontier.orbit;
  const double period = orbit.loop.period * units.time;
  if (frontier.on_energy_limit)
    return Ending{EndReason::energy_limit, fmt::format("E = {:.12g}", orbit.energy * units.energy())};
  if (orbit.loop.period >= options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("T = {:.12g}", period)};
  if (orbit.step + 1 >= options.step_limit)
    return Ending{EndReason::step_limit, fmt::format("{} orbits", orbit.step + 1)};
  if (orbit.step <= first_orbits) return std::nullopt;
  const double amplitude = frontier.problem.amplitude;
  if (amplitude < vanishing_amplitude * std::min(frontier.first_amplitude, options.start_amplitude))
    return Ending{EndReason::fixed_point, fmt::format("T = {:.9g}, amplitude {:.2e}", period, amplitude)};
  // Neither T nor the amplitude can be further apart than the loops are: a cheap look before the distance itself.
  const double near = closing * frontier.last_increment;
  if (near < was_away * frontier.farthest &&
      std::abs(orbit.loop.period - frontier.first.period) < near * frontier.first.period &&
      std::abs(amplitude - frontier.first_amplitude) < near && arclength_between(frontier.first, orbit.loop) < near)
    return Ending{EndReason::closed_loop, fmt::format("T = {:.9g}, length {:.6g}", period, orbit.arclength)};
  return std::nullopt;
}

std::optional<Ending> beyond_limits(double period, double energy, const Options& options,
                                    const systems::Scales& units) {
  if (period > options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("begins beyond it, at T = {:.9g}", period * units.time)};
  if (energy > options.energy_to || energy < options.energy_from)
    return Ending{EndReason::energy_limit, fmt::format("begins beyond it, at E = {:.9g}", energy * units.energy())};
  return std::nullopt;
}

namespace {

bool period_diverges(const Frontier& frontier) {
  const Orbit& orbit = frontier.orbit;
  if (orbit.loop.modes.empty() || orbit.loop.period < grown_period * frontier.first.period) return false;
  const double range = std::abs(orbit.energy - frontier.first_energy);
  return std::abs(orbit.energy - frontier.earlier_energy) < settled_energy * range;
}

}  // namespace

Ending end_between(const Frontier& frontier, EndReason reason, std::string detail, const systems::Scales& units) {
  if (!period_diverges(frontier)) return {reason, std::move(detail)};
  return {EndReason::period_divergence,
          fmt::format("T = {:.6g}, E = {:.12g}; {}", frontier.orbit.loop.period * units.time,
                      frontier.orbit.energy * units.energy(), detail)};
}

}  // namespace orbweaver::continuation
