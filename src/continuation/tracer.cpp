#include "tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "branch_end.hpp"
#include "least_guard.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/continuation/way_from_start.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "step_control.hpp"

namespace orbweaver::continuation {

namespace {

/// Orbits from one look for another general time map to the next: a fit costs 3 to 20 ms (docs/performance.md).
constexpr int refit_every = 32;
/// The second step is at most so many times the first orbit's distance, which is given and not a matter of errors; one
/// that is too long is halved. Not measured.
constexpr double growth_after_first = 4.0;
/// The first orbit's amplitude is halved down to this share: about twenty attempts.
constexpr double least_start = 1e-6;
/// Of the least amplitude at which a speed is known, by the linear motion: the first orbit's speed differs from that.
constexpr double above_least_known = 2.0;
/// Of an equilibrium without an orbit as near as the scene says: where a first orbit lies unless it says anything.
constexpr double usual_at_rest = 8.7e-3;
/// A direction of which z(s = 0) has less than this share (of squared lengths) is scaled by its length instead.
constexpr double still_at_start = 1e-16;
/// Of the angle between a branch's direction at its crossing and the way to its first orbit, which bends with the
/// distance: those of the shipped scenes have 0.88 or more, one that had gone over to another family 0.62.
constexpr double first_share = 0.85;
/// Of a step's length where the step went over to another family: the next attempt.
constexpr double shortened_after_jump = 0.3;
/// The same of the length allowed to the attempt before, once an attempt has come out no shorter.
constexpr double halved_where_stuck = 0.5;
/// A step that may not be longer than a given length may be halved three times all the same.
constexpr double least_of_longest = 0.1;
/// A prediction that is wrong by so many times the wanted error (0.3 rad) has met another family: errors of one family
/// change by factors from step to step, not by this. Not measured.
constexpr double wrong_prediction = 100.0;
/// Of the wanted error of predictions: where one is wrong by less and the equations are not solved, a shorter step
/// helps less than a finer resolution.
constexpr double well_foreseen = 0.1;
/// Halvings of one step from which it goes along the family's direction: the polynomial may point back after a bend.
constexpr int polynomial_attempts = 3;
/// A fixed step of z(s = 0) may take so many times the largest step where z(s = 0) moves less than the loop.
constexpr double fixed_in_largest = 5.0;
/// Keeps the quotient finite where z(s = 0) does not move; below any step that `fixed_in_largest` does not bound.
constexpr double least_change = 1e-12;

}  // namespace

Tracer::Tracer(std::shared_ptr<const systems::System> system, Start start, Options options)
    : _system(std::move(system)),
      _start(std::move(start)),
      _options(std::move(options)),
      _problem(make_point_problem({*_system, _start.base, _start.isotropy}, _options, _frontier.problem)),
      _stepper(*_problem, _options, _frontier),
      _limits(*_system, *_problem, _stepper, _options, _frontier) {}

void Tracer::go_on_from(Frontier frontier) {
  _frontier = std::move(frontier);
  _problem->state_replaced();
}

std::optional<Orbit> Tracer::advance() {
  if (_ending) return std::nullopt;
  _limits.begin();
  if (!begun()) return _start.base_is_orbit ? base_orbit() : first_orbit();
  _ending = end_at(_frontier, _problem->scalars_at(), *_system, _options);
  return _ending ? std::nullopt : next_on_family();
}

std::optional<Orbit> Tracer::end(EndReason reason, std::string detail) {
  _ending = end_between(_frontier, *_system, reason, std::move(detail));
  return std::nullopt;
}

std::optional<Orbit> Tracer::first_orbit() {
  const loop::Tangent direction = start_direction();
  const bool is_at_rest = loop::rms_amplitude(_start.base) == 0.0;
  const double least =
      is_at_rest ? above_least_known * corrector::least_known_amplitude(*_system, _start.base, direction) : 0.0;
  const double nearest = std::max(least, least_start * _options.start_amplitude);
  double amplitude = std::max(_options.start_amplitude, least);
  _frontier.problem.held_energy = energy_of(*_system, _start.base);
  const bool has_direction = !is_at_rest && _start.base.time_map.is_identity() && !_start.direction.modes.empty();
  // Where a field loses digits that its coordinates do not tell, as exp(y) - 1 does, rounding hides what is too near.
  bool may_move_out = is_at_rest && amplitude < usual_at_rest;
  const auto is_moved_out = [&] {
    if (may_move_out) amplitude = usual_at_rest;
    return std::exchange(may_move_out, false);
  };
  const Resolution coarsest = _problem->resolution_for(std::max(_start.base.cutoff, _options.cutoff_from),
                                                       _start.base.time_map, _options.cutoff_to);
  _problem->resolve(coarsest);
  while (true) {
    // Beside an orbit everything is measured by the orbit, however near the first one of the family lies.
    _frontier.problem.amplitude = extent_of(_start.base.winding, std::max(amplitude, loop::rms_amplitude(_start.base)));
    const std::vector<double> base = _problem->from_loop(_start.base);
    Prediction prediction{base, _problem->from_change(loop::perturbation(_start.base, direction)), 1};
    for (std::size_t n = 0; n < direction.scalars.size(); ++n)
      prediction.tangent[_problem->scalars_at() + n] += direction.scalars[n];
    for (std::size_t n = 0; n < base.size(); ++n) prediction.values[n] += amplitude * prediction.tangent[n];
    const std::vector<double> conditions = _problem->conditions_at(prediction);
    Trial trial = _problem->correct(std::move(prediction), conditions);
    if (_stepper.needs_more_harmonics(trial)) {
      const std::optional<Resolution> finer = _problem->next_resolution(_options.cutoff_to);
      if (!finer && !is_moved_out())
        return end(EndReason::cutoff_limit, fmt::format("the first orbit needs more than K = {}", _options.cutoff_to));
      _problem->resolve(finer ? *finer : coarsest);
      continue;
    }
    // Where the way has left the branch's direction it may have gone over to another family.
    if (trial.is_orbit && has_direction && 0.5 * amplitude >= nearest &&
        way_from(_start, trial.loop).share < first_share) {
      amplitude *= 0.5;
      continue;
    }
    if (trial.is_orbit) {
      _frontier.points = {{base, 0.0}};
      _ending = beyond_limits(*_system, trial.loop, scalar(trial, 0), _options);
      if (_ending) return std::nullopt;
      _frontier.next_length =
          std::min(growth_after_first * _problem->distance(trial.values, base), _options.largest_step);
      const Frontier before = _frontier;
      Orbit first = accept(trial);
      if (_options.too_far && 0.5 * amplitude >= nearest && _options.too_far(first)) {
        go_on_from(before);
        amplitude *= 0.5;
        continue;
      }
      if (amplitude > _options.start_amplitude) first.moved_out = amplitude / _options.start_amplitude;
      return first;
    }
    _frontier.problem.factor_point.clear();
    using equations::Preconditioner;  // both kinds of cells at each amplitude
    Preconditioner& cells = _frontier.problem.preconditioner;
    const bool both_tried = cells != Preconditioner::box || !_problem->can_fit_cells();
    cells = both_tried ? Preconditioner::box : Preconditioner::fitted_box;
    if (!both_tried) continue;
    amplitude *= 0.5;
    if (amplitude >= nearest) continue;
    if (!is_moved_out()) return end(EndReason::failure, fmt::format("no orbit near the start: {}", trial.reason));
    _problem->resolve(coarsest);
  }
}

std::optional<Orbit> Tracer::base_orbit() {
  const std::vector<double>& scalars = _start.direction.scalars;
  const auto held = static_cast<std::size_t>(
      std::find_if(scalars.begin(), scalars.end(), [](double v) { return v != 0.0; }) - scalars.begin());
  _frontier.problem.held_energy = energy_of(*_system, _start.base);
  _frontier.problem.amplitude = extent_of(_start.base.winding, loop::rms_amplitude(_start.base));
  _problem->resolve(_problem->resolution_for(std::max(_start.base.cutoff, _options.cutoff_from), _start.base.time_map,
                                             _options.cutoff_to));
  while (true) {
    const std::vector<double> base = _problem->from_loop(_start.base);
    Prediction prediction{base, std::vector<double>(base.size(), 0.0), 1};
    prediction.tangent[_problem->scalars_at() + held] = scalars[held];
    const std::vector<double> conditions = _problem->conditions_with(prediction, static_cast<int>(held));
    Trial trial = _problem->correct(prediction, conditions);
    if (_stepper.needs_more_harmonics(trial)) {
      const std::optional<Resolution> finer = _problem->next_resolution(_options.cutoff_to);
      if (!finer)
        return end(EndReason::cutoff_limit, fmt::format("the first orbit needs more than K = {}", _options.cutoff_to));
      _problem->resolve(*finer);
      continue;
    }
    if (!trial.is_orbit) return end(EndReason::failure, fmt::format("no orbit near the start: {}", trial.reason));
    _ending = beyond_limits(*_system, trial.loop, scalar(trial, 0), _options);
    if (_ending) return std::nullopt;
    // The family's direction stands for an orbit before this one.
    prediction.values = trial.values;
    std::vector<double> before = trial.values;
    const std::vector<double> direction = _problem->direction_at(trial.values, prediction);
    std::vector<double> beyond = trial.values;
    for (std::size_t n = 0; n < beyond.size(); ++n) beyond[n] += direction[n];
    const double length = std::sqrt(_problem->product(beyond, trial.values, beyond, trial.values));
    for (std::size_t n = 0; n < before.size(); ++n) before[n] -= _options.start_amplitude / length * direction[n];
    _frontier.points = {{std::move(before), 0.0}};
    _frontier.next_length = std::min(_options.start_amplitude, _options.largest_step);
    return accept(trial);
  }
}

/// The start's direction with unit |dz(s = 0)| (or unit length of its modes where z(s = 0) does not move).
loop::Tangent Tracer::start_direction() const {
  double square = 0.0;
  for (const double v : loop::state_at(loop::perturbation(_start.base, _start.direction), 0.0)) square += v * v;
  double length = 0.0;
  for (const double v : _start.direction.modes) length += v * v;
  if (length == 0.0)  // along a parameter
    for (const double v : _start.direction.scalars) length += v * v;
  const double unit = square > still_at_start * length ? std::sqrt(square) : std::sqrt(length);
  loop::Tangent direction = _start.direction;
  for (std::vector<double>* numbers : {&direction.modes, &direction.scalars})
    for (double& v : *numbers) v /= unit;
  return direction;
}

/// Steps after which the branch would be on another family are taken back and shortened.
std::optional<Orbit> Tracer::next_on_family() {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (!_options.jumped) return next_orbit(unlimited);
  const Frontier before = _frontier;
  double at_most = unlimited;
  double increment = unlimited;
  bool is_stuck = false;
  std::optional<Orbit> next = next_orbit(at_most);
  while (next && _frontier.last_increment > _options.smallest_jump && _options.jumped(before.orbit, *next)) {
    // Where T changes fast an increment is many times the problem's length of a step, and shortens nothing.
    is_stuck = is_stuck || _frontier.last_increment >= increment;
    increment = _frontier.last_increment;
    at_most = std::min(shortened_after_jump * increment, is_stuck ? halved_where_stuck * at_most : unlimited);
    go_on_from(before);
    next = next_orbit(at_most);
  }
  return next;
}

std::optional<Orbit> Tracer::next_orbit(double at_most) {
  const double amplitude = _frontier.problem.amplitude;
  const double least =
      std::min(_options.smallest_step * (1.0 + amplitude) * std::min(1.0, amplitude), least_of_longest * at_most);
  _stepper.begin();
  const double longest = std::min(std::max(length_to_try(), least), at_most);
  double length = longest;
  const int least_size = _frontier.problem.least_size;
  std::optional<Resolution> before_doubling;
  bool may_double = true;
  for (int halved = 0;; ++halved) {
    if (halved >= polynomial_attempts) _stepper.use_tangent();
    Trial trial = _stepper.step(length);
    const double wanted = _options.prediction_error * std::min(1.0, amplitude);
    const bool jumped = trial.prediction_error > wrong_prediction * wanted ||
                        (trial.converged && (has_passed_rest(trial) || _stepper.turned_too_far(trial, length)));
    const bool needs_more = !jumped && _stepper.needs_more_harmonics(trial);
    if (needs_more && !before_doubling) {
      if (!_stepper.refine(trial))
        return end(EndReason::cutoff_limit, fmt::format("the next orbit needs more than K = {}", _options.cutoff_to));
      --halved;
      continue;
    }
    if (trial.is_orbit && !jumped && !needs_more) {
      _frontier.next_length =
          std::min(next_step_length(length, trial.prediction_error, wanted, trial.order), _options.largest_step);
      _halvings = halvings_of_step(trial.prediction_error, wanted, trial.order);
      OnLimit within = _limits.within(trial, length);
      if (within.trial) return accept(*within.trial);
      // The step may have gone over to another family, on which there is no such orbit.
      Ending& refused = within.ending;
      if (!refused.failed() || 0.5 * length < least) return end(refused.reason, std::move(refused.detail));
      trial.reason = std::move(refused.detail);
      _limits.forget();
    }
    _frontier.problem.factor_point.clear();
    const bool is_foreseen =
        trial.converged && !trial.is_orbit && !jumped && trial.prediction_error < well_foreseen * wanted;
    const std::optional<Resolution> coarser = std::exchange(before_doubling, std::nullopt);
    if (coarser && needs_more) {  // it was not that
      (void)_stepper.resolve(*coarser);
      _frontier.problem.least_size = least_size;
    } else if (is_foreseen && may_double) {
      may_double = false;
      before_doubling = _problem->resolution();
      if (resolve_twice()) {
        --halved;
        continue;
      }
      before_doubling.reset();
    }
    length *= 0.5;
    if (!(length >= least) && jumped && trial.converged && resolve_twice()) {
      length = longest;
      halved = -1;
      continue;
    }
    if (!(length >= least)) {
      std::string detail =
          fmt::format("the corrector fails at T = {:.6g} even with step {:.1e}: {}",
                      here().period * _system->scales().time, length, jumped ? "it leaves the family" : trial.reason);
      if (!(trial.known_to > length)) return end(EndReason::failure, std::move(detail));
      return end(EndReason::undecided,
                 fmt::format("rounding leaves orbits open by {:.1e}; {}", trial.known_to, std::move(detail)));
    }
  }
}

/// Whether the step led across an equilibrium. Where an angle winds orbits are none, and the rest of the loop may pass
/// through zero: the answer to a drive does where the drive has no strength.
bool Tracer::has_passed_rest(const Trial& trial) {
  return !winds(_start.base.winding) && _problem->inverted(trial, _stepper.last());
}

/// Twice as finely from here on. Beside a resonance the cells' own error in the phase, which the preconditioner has,
/// may be larger than what an index is from 2: the equations are solved along all directions but the one that tells the
/// family from its neighbours, and the shortest step turns. The tail shows nothing of it.
bool Tracer::resolve_twice() {
  const int before = _problem->resolution().size;
  std::optional<Resolution> finer;
  while (_problem->resolution().size < 2 * before && (finer = _problem->next_resolution(_options.cutoff_to)))
    (void)_stepper.resolve(*finer);
  if (_problem->resolution().size == before) return false;
  _frontier.problem.least_size = _problem->resolution().size;
  return true;
}

double Tracer::length_to_try() {
  if (!_options.fixed_step) return std::min(_frontier.next_length, _options.largest_step);
  // Where z(s = 0) hardly moves (a fold of it, a divergence) the step in loop space is bounded all the same.
  return std::min(*_options.fixed_step / std::max(_stepper.change_at_start(), least_change),
                  fixed_in_largest * _options.largest_step);
}

Orbit Tracer::accept(const Trial& trial) {
  Orbit orbit;
  orbit.loop = trial.loop;
  orbit.energy = energy_of(*_system, trial.loop);
  orbit.action = _problem->action(trial);
  orbit.loss_rms = trial.loss_rms;
  orbit.tolerance_met = trial.tolerance_met;
  orbit.tail = loop::tail(orbit.loop);
  orbit.iterations = trial.iterations;
  orbit.halvings = std::exchange(_halvings, 0);
  const std::vector<double>& before = _stepper.last();
  _frontier.threshold = trial.threshold;
  keep(orbit, begun() ? _problem->distance(trial.values, before) : 0.0, trial.amplitude);
  _frontier.tangent = {};
  // The length that the step has come out with: a parameter of its own would drift from extrapolation to extrapolation.
  const double length = std::sqrt(_problem->product(trial.values, before, trial.values, before));
  std::vector<TracePoint>& points = _frontier.points;
  points.push_back({trial.values, points.back().parameter + length});
  const auto kept = static_cast<std::size_t>(_options.predictor_order) + 1;
  if (points.size() > kept) points.erase(points.begin());
  if (_options.off_branch_spectrum) {
    complete_frontier();
    _frontier.orbit.off_branch_eigenvalue = off_branch_eigenvalue(*_system, here(), _start.isotropy, _frontier.tangent);
  }
  Orbit accepted = _frontier.orbit;
  const bool may_fit = accepted.step % refit_every == 0;
  const std::optional<Resolution> coarser = _problem->coarser(trial, here(), may_fit);
  if (coarser && coarser->size >= _frontier.problem.least_size) _stepper.resolve(*coarser);
  return accepted;
}

void Tracer::keep(Orbit& orbit, double increment, double amplitude) {
  Frontier& frontier = _frontier;
  if (begun()) {
    frontier.last_increment = increment;
    orbit.step = frontier.orbit.step + 1;
    orbit.arclength = frontier.orbit.arclength + increment;
    if (orbit.loop.period > period_window * frontier.earlier_period) {
      frontier.earlier_level = level_of(*_system, frontier.orbit);
      frontier.earlier_period = here().period;
    }
  } else {
    frontier.first = orbit.loop;
    frontier.first_amplitude = amplitude;
    frontier.first_level = frontier.earlier_level = level_of(*_system, orbit);
    frontier.earlier_period = orbit.loop.period;
  }
  keep_guards(orbit.loop);
  frontier.problem.amplitude = extent_of(orbit.loop.winding, amplitude);
  frontier.orbit = orbit;
}

void Tracer::keep_guards(const loop::Loop& loop) {
  std::vector<GuardTrace>& guards = _frontier.guards;
  const bool first = !begun();
  guards.resize(_system->structure().guards.size());
  for (std::size_t k = 0; k < guards.size(); ++k) {
    GuardTrace& guard = guards[k];
    const double least = least_guard(*_system, static_cast<int>(k), loop);
    if (!first) guard.earlier.push_back(guard.least);
    if (guard.earlier.size() > earlier_guards) guard.earlier.erase(guard.earlier.begin());
    if (first || !(least < guard.least)) guard.fallen_from = least;
    guard.least = least;
  }
}

void Tracer::complete_frontier() {
  if (!begun() || !_frontier.tangent.empty()) return;
  _frontier.tangent = _problem->tangent_of(_problem->direction_at(_stepper.last(), _stepper.here()), here());
}

}  // namespace orbweaver::continuation
