#include "orbweaver/continuation/branch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "attempt.hpp"
#include "branch_implementation.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"

namespace orbweaver::continuation {

std::optional<Orbit> Branch::Implementation::end(EndReason reason, std::string detail) {
  const bool at_its_end = reason == EndReason::cutoff_limit || reason == EndReason::failure;
  if (at_its_end && period_diverges()) {
    detail = fmt::format("T = {:.6g}, E = {:.12g}; {}", here().period, frontier.orbit.energy, detail);
    reason = EndReason::period_divergence;
  }
  ending = Ending{reason, std::move(detail)};
  return std::nullopt;
}

/// Steps after which the branch would be on another family are taken back and shortened.
std::optional<Orbit> Branch::Implementation::next_on_family() {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (!options.jumped) return next_orbit(unlimited);
  const Frontier before = frontier;
  std::optional<Orbit> next = next_orbit(unlimited);
  while (next && frontier.last_increment > options.smallest_jump && options.jumped(before.orbit, *next)) {
    const double length = 0.3 * frontier.last_increment;
    frontier = before;
    forget();
    next = next_orbit(length);
  }
  return next;
}

// T has more than doubled, and over its last tenth the energy has moved by less than a thousandth of its range.
bool Branch::Implementation::period_diverges() const {
  if (!begun() || here().period < 2.0 * frontier.first.period) return false;
  const double range = std::abs(frontier.orbit.energy - frontier.first_energy);
  return std::abs(frontier.orbit.energy - frontier.earlier_energy) < 1e-3 * range;
}

std::optional<Ending> Branch::Implementation::beyond_limits(double period, double energy) const {
  if (period > options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("begins beyond it, at T = {:.9g}", period)};
  if (energy > options.energy_to || energy < options.energy_from)
    return Ending{EndReason::energy_limit, fmt::format("begins beyond it, at E = {:.9g}", energy)};
  return std::nullopt;
}

void Branch::Implementation::keep(Orbit& orbit, double increment, double amplitude) {
  if (begun()) {
    frontier.last_increment = increment;
    orbit.step = frontier.orbit.step + 1;
    orbit.arclength = frontier.orbit.arclength + increment;
    if (orbit.loop.period > 1.1 * frontier.earlier_period) {
      frontier.earlier_energy = frontier.orbit.energy;
      frontier.earlier_period = here().period;
    }
  } else {
    frontier.first = orbit.loop;
    frontier.first_amplitude = amplitude;
    frontier.first_energy = frontier.earlier_energy = orbit.energy;
    frontier.earlier_period = orbit.loop.period;
  }
  frontier.amplitude = amplitude;
  frontier.farthest = std::max({frontier.farthest, std::abs(amplitude - frontier.first_amplitude),
                                std::abs(orbit.loop.period / frontier.first.period - 1.0)});
  frontier.orbit = orbit;
}

std::optional<Ending> Branch::Implementation::end_at(const Orbit& orbit) const {
  if (frontier.on_energy_limit) return Ending{EndReason::energy_limit, fmt::format("E = {:.12g}", orbit.energy)};
  if (orbit.loop.period >= options.period_limit)
    return Ending{EndReason::period_limit, fmt::format("T = {:.12g}", orbit.loop.period)};
  if (orbit.step + 1 >= options.step_limit)
    return Ending{EndReason::step_limit, fmt::format("{} orbits", orbit.step + 1)};
  if (orbit.step <= 3) return std::nullopt;
  if (frontier.amplitude < 0.5 * std::min(frontier.first_amplitude, options.start_amplitude))
    return Ending{EndReason::fixed_point,
                  fmt::format("T = {:.9g}, amplitude {:.2e}", orbit.loop.period, frontier.amplitude)};
  // Neither T nor the amplitude can be further apart than the loops are: a cheap look before the distance itself.
  const double near = 0.5 * frontier.last_increment;
  if (near < 0.25 * frontier.farthest &&
      std::abs(orbit.loop.period - frontier.first.period) < near * frontier.first.period &&
      std::abs(frontier.amplitude - frontier.first_amplitude) < near &&
      arclength_between(frontier.first, orbit.loop) < near)
    return Ending{EndReason::closed_loop, fmt::format("T = {:.9g}, length {:.6g}", orbit.loop.period, orbit.arclength)};
  return std::nullopt;
}

Branch::Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options) {
  loop::validate(start.base);
  core::require(start.direction.modes.size() == start.base.modes.size(),
                "a start's direction needs the size of its base loop's modes");
  core::require(start.direction.norm() > 0.0, "a start's direction must not be zero");
  core::require(options.predictor_order >= 1, "a predictor needs a polynomial of degree 1 or more");
  core::require(loop::is_invariant(start.base.time_map, start.isotropy),
                "the time map of a start must have the symmetries of its isotropy");
  if (options.corrector.method == corrector::Method::automatic)
    _implementation = make_collocation_branch(system, start, options);
  if (!_implementation) _implementation = make_loop_branch(std::move(system), start, options);
}

Branch::Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options, Frontier from)
    : Branch(std::move(system), start, std::move(options)) {
  loop::validate(from.orbit.loop);
  _implementation->frontier = std::move(from);
}

Branch::~Branch() = default;
Branch::Branch(Branch&&) noexcept = default;
Branch& Branch::operator=(Branch&&) noexcept = default;

std::optional<Orbit> Branch::advance() {
  const core::LogStage stage(core::Stage::continuation);
  return _implementation->advance();
}
const std::optional<Ending>& Branch::ending() const { return _implementation->ending; }
const Frontier& Branch::frontier() {
  _implementation->complete_frontier();
  return _implementation->frontier;
}
const Frontier& Branch::standing() const { return _implementation->frontier; }

Ending trace(std::shared_ptr<const systems::System> system, const Start& start, const Options& options,
             const Observer& observer) {
  Branch branch(std::move(system), start, options);
  while (const std::optional<Orbit> orbit = branch.advance())
    if (!observer(*orbit)) return {EndReason::stopped, fmt::format("T = {:.9g}", orbit->loop.period)};
  return branch.ending().value();
}

corrector::Result orbit_at_period(const systems::System& system, const loop::Loop& near, const loop::Isotropy& isotropy,
                                  double period, const Options& options) {
  loop::Loop guess = near;
  guess.period = period;
  while (true) {
    const loss::Unknowns unknowns{loop::Subspace(guess.dimension, guess.cutoff, isotropy), {loss::Scalar::period()}};
    const Eigen::VectorXd pinned = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
    corrector::Result result = corrector::correct(system, guess, unknowns,
                                                  loss::Slice(unknowns.size(), conditions_at(guess, unknowns, pinned)),
                                                  options.corrector, pinned);
    const int larger = loop::next_cutoff(guess.cutoff);
    if (!needs_more_harmonics(result, options) || larger > options.cutoff_to) return result;
    guess = loop::with_cutoff(guess, larger);
  }
}

}  // namespace orbweaver::continuation
