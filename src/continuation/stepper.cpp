#include "stepper.hpp"

#include <cmath>

namespace orbweaver::continuation {

namespace {

/// Iterations of the last correction above which the preconditioner is built anew (docs/performance.md: 4 to 9 cost
/// the same).
constexpr int renew_after = 7;

/// Failed corrections in a row that may ask for more harmonics: then the step is too long, whatever the tail looks
/// like.
constexpr int raises_at_most = 3;

}  // namespace

Prediction Stepper::here() const {
  return extrapolate(_frontier.points, _options.predictor_order, _frontier.points.back().parameter);
}

void Stepper::use_tangent() {
  if (!_tangent) _tangent = along_tangent();
}

/// The family's own direction at the last point, on the side of the step that led there, as a step of length 1.
Prediction Stepper::along_tangent() {
  const Prediction chord = extrapolate(_frontier.points, 1, _frontier.points.back().parameter);
  Prediction out{last(), _problem.direction_at(last(), chord), 1};
  for (std::size_t n = 0; n < out.values.size(); ++n) out.values[n] += out.tangent[n];
  const double length = std::sqrt(_problem.product(out.values, last(), out.values, last()));
  for (double& v : out.tangent) v /= length;
  return scaled(out, 1.0);
}

Prediction Stepper::scaled(Prediction step, double length) const {
  step.values = last();
  for (std::size_t n = 0; n < step.values.size(); ++n) step.values[n] += length * step.tangent[n];
  return step;
}

double Stepper::change_at_start() {
  if (_options.predictor == Predictor::tangent) use_tangent();
  return _problem.change_at_start(_tangent ? _tangent->tangent : here().tangent);
}

Trial Stepper::step(double length) {
  if (_options.predictor == Predictor::tangent) use_tangent();
  return correct(
      _tangent ? scaled(*_tangent, length)
               : extrapolate(_frontier.points, _options.predictor_order, _frontier.points.back().parameter + length));
}

Trial Stepper::correct(Prediction prediction, std::optional<int> held_scalar) {
  // A factor that has grown stale costs more iterations than a new one.
  if (_frontier.orbit.iterations > renew_after || held_scalar) _frontier.problem.factor_point.clear();
  if (!held_scalar) _problem.settle(prediction, last());
  const std::vector<double> conditions =
      held_scalar ? _problem.conditions_with(prediction, *held_scalar) : _problem.conditions_at(prediction);
  return _problem.correct(std::move(prediction), conditions);
}

bool Stepper::turned_too_far(const Trial& trial, double length) {
  const std::vector<double>& before = _frontier.points[_frontier.points.size() - 2].values;
  const double step = std::sqrt(_problem.product(trial.values, last(), trial.values, last()));
  if (_options.least_cosine * step > length) return true;
  const auto turned = [&](const std::vector<double>& from, const std::vector<double>& to) {
    return _problem.product(trial.values, last(), to, from) <
           _options.least_cosine * step * std::sqrt(_problem.product(to, from, to, from));
  };
  if (!turned(before, last())) return false;
  use_tangent();
  return turned(last(), _tangent->values);
}

bool Stepper::needs_more_harmonics(Trial& trial) {
  if (trial.converged) return !_problem.resolved(trial);
  if (trial.under_resolved && ++_raised <= raises_at_most) return true;
  _raised = 0;
  return false;
}

std::optional<PointProblem::Transfer> Stepper::refine(const Trial& trial) {
  // At most one new map a step: the next fit would be to the same orbit.
  const bool may_fit = _problem.resolution().time_map == _frontier.orbit.loop.time_map;
  const std::optional<Resolution> wanted = _problem.finer(trial, last(), may_fit);
  if (!wanted) return std::nullopt;
  return resolve(*wanted);
}

PointProblem::Transfer Stepper::resolve(const Resolution& to) {
  _tangent.reset();
  const loop::TimeMap before = _problem.resolution().time_map;
  PointProblem::Transfer transfer = _problem.resolve(to);
  std::vector<TracePoint>& points = _frontier.points;
  for (TracePoint& point : points) point.values = transfer(point.values);
  if (points.size() < 2 || before == to.time_map || to.time_map.coefficients.empty()) return transfer;
  // Lengths are means over s: a general map measures them anew (a somewhat sharper pulse changes them little).
  const double last = points.back().parameter - points[points.size() - 2].parameter;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const std::vector<double>& a = points[n - 1].values;
    const std::vector<double>& b = points[n].values;
    points[n].parameter = points[n - 1].parameter + std::sqrt(_problem.product(b, a, b, a));
  }
  _frontier.next_length *= (points.back().parameter - points[points.size() - 2].parameter) / last;
  return transfer;
}

}  // namespace orbweaver::continuation
