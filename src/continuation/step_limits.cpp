#include "step_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "least_guard.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "turning.hpp"
#include "under_map.hpp"

namespace orbweaver::continuation {

namespace {

/// Where the first orbit lies on a step is off by what its phase is beside the step's end: each correction from beside
/// it takes away most of the distance, unless it is another orbit (bifurcation/identity.cpp has the same).
constexpr double phase_progress = 0.3;

}  // namespace

void StepLimits::forget() {
  _frontier.on_energy_limit = _frontier.on_parameter_limit = _frontier.has_come_back = false;
  _frontier.on_guard_limit = -1;
}

/// Of a branch that may have come back to its first orbit on a step of `length` to `trial`: the orbit of the step at
/// the place of the first, where it is that one: between them nothing would be looked for, and beyond it everything
/// twice. None where the branch goes on.
std::optional<OnLimit> StepLimits::closing_orbit(const Trial& trial, double length) {
  const std::vector<double>& before = _stepper.last();
  // What nowhere turns further from its chord lies in the triangle over it that does at both ends.
  const double beside = 0.5 * std::tan(std::acos(_options.least_cosine));
  const double reach = std::hypot(1.0, beside);
  if (!may_have_come_back(_frontier, trial, reach * _problem.distance(trial.values, before))) return std::nullopt;
  const double step = _problem.product(trial.values, before, trial.values, before);
  if (is_far_off(_system.structure(), _frontier.first, trial.loop, beside, step)) return std::nullopt;
  const auto first_beside = [&](const loop::Loop& other) {
    const loop::Alignment alignment = loop::align_in_time(_system.structure(), _frontier.first, other);
    return _problem.from_loop(under_map(loop::aligned(_frontier.first, alignment), _problem.resolution().time_map));
  };
  const double off_step = beside * beside * step;
  const auto square = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return _problem.product(a, b, a, b);
  };
  std::vector<double> there = first_beside(trial.loop);
  double along = _problem.product(there, before, trial.values, before) / step;
  if (!(along > 0.0 && along <= reach) || square(there, before) - along * along * step > off_step) return std::nullopt;
  const Passed passed{EndReason::closed_loop, "T", _frontier.first.period, length, trial, _system.scales().time};
  const int size = _problem.resolution().size;
  Prediction prediction{before, trial.values, 1};
  for (std::size_t n = 0; n < before.size(); ++n) prediction.tangent[n] -= before[n];
  double least = std::numeric_limits<double>::infinity();
  while (true) {
    for (std::size_t n = 0; n < there.size(); ++n) prediction.values[n] += along * prediction.tangent[n];
    OnLimit closing = orbit_from(_stepper, passed, prediction);
    if (!closing.trial) return closing;
    const double distance = distance_between_orbits(_system, _frontier.first, closing.trial->loop);
    const bool is_first = distance <= same_within(_frontier.first);
    const bool is_settled = _problem.resolution().size != size || !(distance < phase_progress * least);
    if (is_settled && is_first) {
      _frontier.has_come_back = true;
      return closing;
    }
    // Which of the two the branch passes, where both may lie on this step, a shorter one tells.
    if (!is_first &&
        (_problem.resolution().size != size || square(closing.trial->values, prediction.values) > off_step ||
         (is_settled && distance * distance < off_step)))
      return failure(passed, "another orbit is beside it");
    if (is_settled) return std::nullopt;
    least = distance;
    there = first_beside(closing.trial->loop);
    prediction.values = std::move(closing.trial->values);
    along = _problem.product(there, prediction.values, trial.values, before) / step;
  }
}

bool StepLimits::is_beyond_limits(const Trial& trial) const {
  return scalar(trial, 0) > _options.period_limit || is_beyond_energies(energy_of(_system, trial.loop)) ||
         is_beyond_parameters(trial);
}

/// Where a step whose ends lie within the scene's limits, in parts of it, has turned back beyond one.
std::optional<double> StepLimits::turning_beyond_limit(const Trial& trial) const {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  std::vector<TracePoint> points = _frontier.points;
  const double last = points.back().parameter;
  const double step =
      std::sqrt(_problem.product(trial.values, points.back().values, trial.values, points.back().values));
  points.push_back({trial.values, last + step});
  const std::vector<double> leaving = extrapolate(points, _options.predictor_order, last).tangent;
  const std::vector<double> arriving = extrapolate(points, _options.predictor_order, last + step).tangent;
  const auto of_scalar = [&](std::size_t number) {
    const std::size_t at = _problem.scalars_at() + number;
    return CourseOverStep{_frontier.points.back().values[at], trial.values[at], step * leaving[at],
                          step * arriving[at]};
  };
  if (const auto turning = turning_outside(of_scalar(0), -unlimited, _options.period_limit)) return turning;
  if (!_system.family_scalars().free.empty())
    if (const auto turning = turning_outside(of_scalar(1), _options.parameter_from, _options.parameter_to))
      return turning;
  if (!_system.structure().conservative() ||
      !(std::isfinite(_options.energy_from) || std::isfinite(_options.energy_to)))
    return std::nullopt;
  const auto slope = [&](const loop::Loop& at, const std::vector<double>& direction) {
    const std::vector<double> start = loop::state_at(at, 0.0);
    const std::vector<double> moves = loop::state_at(loop::perturbation(at, _problem.change_of(direction, at)), 0.0);
    std::vector<double> gradient(start.size());
    _system.conserved_gradient(0, start, gradient);
    return step * std::inner_product(gradient.begin(), gradient.end(), moves.begin(), 0.0);
  };
  return turning_outside(
      {_frontier.orbit.energy, energy_of(_system, trial.loop), slope(here(), leaving), slope(trial.loop, arriving)},
      _options.energy_from, _options.energy_to);
}

/// The last orbit of a branch lies on the scene's limit, not beyond it; where a step passes two, on the first.
OnLimit StepLimits::within(const Trial& passed, double length) {
  constexpr int period = 0;  // among the scalars
  const std::optional<OnLimit> closing = closing_orbit(passed, length);
  if (closing && !closing->trial) return *closing;
  const Trial& trial = closing ? *closing->trial : passed;
  const double value = energy_of(_system, trial.loop);
  const bool is_late = scalar(trial, period) > _options.period_limit;
  const bool is_outside = is_beyond_energies(value);
  const bool is_beside = is_beyond_parameters(trial);
  if (!is_late && !is_outside && !is_beside) {
    const std::optional<double> turning = turning_beyond_limit(trial);
    if (!turning) return within_guards(trial, length);
    Trial turned = _stepper.step(*turning * length);
    if (_stepper.needs_more_harmonics(turned) || !turned.is_orbit || !is_beyond_limits(turned))
      return within_guards(trial, length);
    return within(turned, *turning * length);
  }
  _met = true;
  OnLimit on_limit;
  if (is_late) {
    on_limit = orbit_at_scalar(
        _stepper, {EndReason::period_limit, "T", _options.period_limit, length, trial, _system.scales().time}, period);
    if (on_limit.trial) on_limit.trial->loop.period = _options.period_limit;
  }
  if (is_outside && (!is_late || (on_limit.trial && is_beyond_energies(energy_of(_system, on_limit.trial->loop))))) {
    const double limit = value > _options.energy_to ? _options.energy_to : _options.energy_from;
    on_limit =
        orbit_at_value(_stepper, {EndReason::energy_limit, "E", limit, length, trial, _system.scales().energy()},
                       _frontier.orbit.energy, [this](const Trial& other) { return energy_of(_system, other.loop); });
    _frontier.on_energy_limit = on_limit.trial.has_value();
  }
  const bool others = is_late || is_outside;
  if (is_beside && (!others || (on_limit.trial && is_beyond_parameters(*on_limit.trial)))) {
    constexpr int parameter = 1;  // among the scalars
    const double limit =
        scalar(trial, parameter) > _options.parameter_to ? _options.parameter_to : _options.parameter_from;
    if (std::abs(here().parameters.front() - limit) <= near_limit * (1.0 + std::abs(limit))) {  // it began there
      return {{},
              {EndReason::parameter_limit, fmt::format("{} = {:.12g}", _system.family_scalars().free.front(),
                                                       limit * _system.scales().parameter(0))}};
    }
    on_limit = orbit_at_scalar(_stepper,
                               {EndReason::parameter_limit, _system.family_scalars().free.front(), limit, length, trial,
                                _system.scales().parameter(0)},
                               parameter);
    if (on_limit.trial) on_limit.trial->loop.parameters.front() = limit;
    _frontier.on_energy_limit = false;
    _frontier.on_parameter_limit = on_limit.trial.has_value();
  }
  if (on_limit.trial) return within_guards(std::move(*on_limit.trial), length);
  return on_limit;
}

/// The same for the limits of guards, where the step of `length` led to `trial` or beyond it.
OnLimit StepLimits::within_guards(Trial trial, double length) {
  for (const auto& [name, limit] : _options.guard_limits) {
    const int guard = guard_number(_system.structure(), name);
    const auto least = [&](const Trial& other) { return least_guard(_system, guard, other.loop); };
    if (!(least(trial) < limit)) continue;
    _met = true;
    OnLimit on_limit = orbit_at_value(_stepper, {EndReason::guard_limit, name, limit, length, trial, 1.0, 0.0},
                                      _frontier.guards[static_cast<std::size_t>(guard)].least, least);
    if (!on_limit.trial) return on_limit;
    trial = std::move(*on_limit.trial);
    _frontier.on_energy_limit = _frontier.on_parameter_limit = false;
    _frontier.on_guard_limit = guard;
  }
  return {std::move(trial), {}};
}

}  // namespace orbweaver::continuation
