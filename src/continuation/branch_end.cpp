#include "branch_end.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "least_guard.hpp"
#include "limit_orbit.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "point_problem.hpp"

namespace orbweaver::continuation {

namespace {

/// Orbits after which a branch may have come back or to a fixed point: the first ones lie near the start anyway.
constexpr int first_orbits = 3;
/// The end at a fixed point, of the first orbit's amplitude and the start's: steps there are of the amplitude's size.
constexpr double vanishing_amplitude = 0.5;
/// How often the period must have grown, and how little of its range the energy may have moved over `period_window`,
/// where the period diverges. Not measured; both decide only how an end is called.
constexpr double grown_period = 2.0;
constexpr double settled_energy = 1e-3;
/// A family collides if the smallest value of a guard, ever falling, has come below this share of where it began to
/// fall, and lost this share of itself over the last `earlier_guards` steps: one that settles at a distance does not.
/// The families of docs/pcr3bp.md end below 0.01 and 0.3. Not measured; both decide only how an end is called.
constexpr double near_guard = 0.1;
constexpr double guard_loss = 0.05;
/// And its harmonics must have grown so many times: it is they that a close approach takes.
constexpr int grown_cutoff = 4;
/// Such a family ends once rounding, which a passage magnifies, lets its orbits be known this many times worse than the
/// tolerance asks: nearer ones take ever more harmonics to resolve noise (docs/performance.md).
constexpr double worse_than_asked = 1e5;
/// What samples may add to the square of a distance. In the surveys of the double pendulum the loops that are far off
/// have 7 times the square of the step and more.
constexpr double beside_by_samples = 2.0;
constexpr int least_density_nodes = 64;
/// What a parameter may change by rounding, in parts of its scale + its value, and a period, in parts of itself.
constexpr double unmoved = 1e-9;

bool collides(const Frontier& frontier, const GuardTrace& guard) {
  return guard.earlier.size() == earlier_guards && guard.least < near_guard * guard.fallen_from &&
         guard.least < (1.0 - guard_loss) * guard.earlier.front() &&
         frontier.orbit.loop.cutoff >= grown_cutoff * frontier.first.cutoff;
}

/// Whether the branch moves along orbits of one parameter value and one period, as a system has that conserves
/// something there. One that comes back to the values of its first orbit has moved.
bool stays(const Frontier& frontier, std::size_t scalars_at) {
  const loop::Loop& first = frontier.first;
  if (first.parameters.empty()) return false;
  const double parameter = first.parameters.front();
  return std::all_of(frontier.points.end() - std::min<std::ptrdiff_t>(first_orbits, std::ssize(frontier.points)),
                     frontier.points.end(), [&](const TracePoint& point) {
                       const double* scalars = point.values.data() + scalars_at;
                       return std::abs(scalars[0] - first.period) < unmoved * first.period &&
                              std::abs(scalars[1] - parameter) < unmoved * (1.0 + std::abs(parameter));
                     });
}

std::optional<Ending> collision_of(const Frontier& frontier, const systems::System& system, const std::string& detail) {
  const systems::Structure& structure = system.structure();
  for (std::size_t k = 0; k < frontier.guards.size(); ++k)
    if (collides(frontier, frontier.guards[k]))
      return Ending{EndReason::collision,
                    fmt::format("{} = {:.6g} at T = {:.6g}; {}", structure.guards[k].name, frontier.guards[k].least,
                                frontier.orbit.loop.period * system.scales().time, detail),
                    "with " + structure.guards[k].body};
  return std::nullopt;
}

}  // namespace

double level_of(const systems::System& system, const Orbit& orbit) {
  return system.family_scalars().free.empty() ? orbit.energy : level_of(system, orbit.loop);
}

int guard_number(const systems::Structure& structure, const std::string& name) {
  const std::vector<systems::Guard>& guards = structure.guards;
  const auto found = std::find_if(guards.begin(), guards.end(), [&](const auto& guard) { return guard.name == name; });
  core::require(found != guards.end(), "a limit needs a guard that the system names");
  return static_cast<int>(found - guards.begin());
}

bool may_have_come_back(const Frontier& frontier, const Trial& trial, double reach) {
  if (frontier.orbit.step < first_orbits) return false;
  const loop::Loop& first = frontier.first;
  double least = std::max(
      std::abs(trial.loop.period / first.period - 1.0),
      std::abs(extent_of(trial.loop.winding, trial.amplitude) - extent_of(first.winding, frontier.first_amplitude)));
  for (std::size_t n = 0; n < first.parameters.size(); ++n)
    least = std::max(least, std::abs(trial.loop.parameters[n] - first.parameters[n]));
  return least < reach;
}

/// By samples in time. A mean over time counts what passes fast for less than one over s, by the density at most.
bool is_far_off(const systems::Structure& structure, const loop::Loop& first, const loop::Loop& loop, double beside,
                double step) {
  const loop::TimeMap& map = loop.time_map;
  const std::vector<double> density = loop::densities(map, loop::nodes_to_resolve(map) + least_density_nodes);
  const double most = *std::max_element(density.begin(), density.end());
  const loop::Loop from = loop::interpolant(loop::time_samples(first));
  const loop::Loop to = loop::interpolant(loop::time_samples(loop));
  const double square = loop::shift_minima(from, to, structure.angles).front().square;
  return square > beside_by_samples * most * (1.0 + beside * beside) * step;
}

std::optional<Ending> end_at(const Frontier& frontier, std::size_t scalars_at, const systems::System& system,
                             const Options& options) {
  const systems::Structure& structure = system.structure();
  const systems::Scales& units = system.scales();
  const Orbit& orbit = frontier.orbit;
  const double period = orbit.loop.period * units.time;
  if (frontier.on_guard_limit >= 0) {
    const auto guard = static_cast<std::size_t>(frontier.on_guard_limit);
    return Ending{EndReason::guard_limit,
                  fmt::format("{} = {:.12g}", structure.guards[guard].name, frontier.guards[guard].least)};
  }
  if (frontier.on_parameter_limit)
    return Ending{EndReason::parameter_limit, fmt::format("{} = {:.12g}", system.family_scalars().free.front(),
                                                          orbit.loop.parameters.front() * units.parameter(0))};
  if (frontier.on_energy_limit)
    return Ending{EndReason::energy_limit, fmt::format("E = {:.12g}", orbit.energy * units.energy())};
  if (orbit.loop.period >= options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("T = {:.12g}", period)};
  if (orbit.step + 1 >= options.step_limit)
    return Ending{EndReason::step_limit, fmt::format("{} orbits", orbit.step + 1)};
  if (orbit.step <= first_orbits) return std::nullopt;
  if (frontier.threshold > worse_than_asked * options.corrector.tolerance)
    if (auto collision = collision_of(frontier, system, fmt::format("rounding leaves {:.1e}", orbit.loss_rms)))
      return collision;
  if (stays(frontier, scalars_at))
    return Ending{
        EndReason::undecided,
        fmt::format("T and {} stay at {:.9g} and {:.9g}: its orbits are not isolated; another start "
                    "(starts.states) may lead away",
                    system.family_scalars().free.front(), period, orbit.loop.parameters.front() * units.parameter(0))};
  const double amplitude = frontier.problem.amplitude;
  if (amplitude < vanishing_amplitude * std::min(frontier.first_amplitude, options.start_amplitude))
    return Ending{EndReason::fixed_point, fmt::format("T = {:.9g}, amplitude {:.2e}", period, amplitude)};
  if (frontier.has_come_back)
    return Ending{EndReason::closed_loop, fmt::format("T = {:.9g}, length {:.6g}", period, orbit.arclength)};
  return std::nullopt;
}

bool is_beyond_parameters(double value, const Options& options) {
  return value > options.parameter_to + near_limit * (1.0 + std::abs(options.parameter_to)) ||
         value < options.parameter_from - near_limit * (1.0 + std::abs(options.parameter_from));
}

std::optional<Ending> beyond_limits(const systems::System& system, const loop::Loop& first, double period,
                                    const Options& options) {
  const systems::Scales& units = system.scales();
  const double energy = energy_of(system, first);
  if (period > options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("left out: begins at T = {:.9g}, beyond {:g}",
                                                       period * units.time, options.period_limit * units.time)};
  if (energy > options.energy_to || energy < options.energy_from)
    return Ending{EndReason::energy_limit,
                  fmt::format("left out: begins at E = {:.9g}, outside [{:g}, {:g}]", energy * units.energy(),
                              options.energy_from * units.energy(), options.energy_to * units.energy())};
  if (!first.parameters.empty())
    if (const double value = first.parameters.front(); is_beyond_parameters(value, options)) {
      const double unit = units.parameter(0);
      return Ending{
          EndReason::parameter_limit,
          fmt::format("left out: begins at {} = {:.9g}, outside [{:g}, {:g}]", system.family_scalars().free.front(),
                      value * unit, options.parameter_from * unit, options.parameter_to * unit)};
    }
  for (const auto& [name, limit] : options.guard_limits)
    if (const double least = least_guard(system, guard_number(system.structure(), name), first); least < limit)
      return Ending{EndReason::guard_limit,
                    fmt::format("left out: begins at {} = {:.9g}, below {:g}", name, least, limit)};
  return std::nullopt;
}

namespace {

bool period_diverges(const Frontier& frontier, const systems::System& system) {
  const Orbit& orbit = frontier.orbit;
  if (orbit.loop.modes.empty() || orbit.loop.period < grown_period * frontier.first.period) return false;
  const double level = level_of(system, orbit);
  return std::abs(level - frontier.earlier_level) < settled_energy * std::abs(level - frontier.first_level);
}

}  // namespace

Ending end_between(const Frontier& frontier, const systems::System& system, EndReason reason, std::string detail) {
  const systems::Scales& units = system.scales();
  if (!period_diverges(frontier, system)) {
    if (std::optional<Ending> collision = collision_of(frontier, system, detail)) return *std::move(collision);
    return {reason, std::move(detail)};
  }
  return {EndReason::period_divergence,
          system.family_scalars().free.empty()
              ? fmt::format("T = {:.6g}, E = {:.12g}; {}", frontier.orbit.loop.period * units.time,
                            frontier.orbit.energy * units.energy(), detail)
              : fmt::format("T = {:.6g}, {} = {:.12g}; {}", frontier.orbit.loop.period * units.time,
                            system.family_scalars().free.front(),
                            frontier.orbit.loop.parameters.front() * units.parameter(0), detail)};
}

}  // namespace orbweaver::continuation
