#include "orbweaver/continuation/locus_curve.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "collocation_problem.hpp"
#include "locus_limits.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "step_control.hpp"

namespace orbweaver::continuation {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Length over which the test function is differentiated at the start: its own error, 1e-10, leaves six digits.
constexpr double difference = 1e-4;
/// Of a place across the curve, and of a place along it where that is looked for: as of crossings.
constexpr double place_tolerance = 1e-11;
/// The zero across the curve is bracketed by its linear estimate times these: the second where the curve bends.
/// The last: on the way across orbits of more symmetry the slope changes its sign.
constexpr std::array<double, 4> brackets{1.5, 4.0, 12.0, -1.5};
/// The smallest linear estimate that is bracketed, in parts of the wanted error: below it the bracket would be as wide
/// as the tolerance.
constexpr double least_estimate = 1e-6;
/// The first step, in parts of the largest: nothing is known of the curve's bend.
constexpr double first_step = 0.1;
/// Degree of the polynomial through the last points that predicts the next: they are few, and their places exact to
/// 1e-11 only.
constexpr int order = 3;
/// A step that has come to less than this share of the largest fails.
constexpr double least_step = 1e-6;
/// How near to the start, in parts of the way back to it, a curve has closed.
constexpr double closed = 1e-6;

using Vector = std::vector<double>;

void add(Vector& to, double factor, const Vector& v) {
  for (std::size_t n = 0; n < to.size(); ++n) to[n] += factor * v[n];
}

class LocusTracer {
 public:
  LocusTracer(const systems::System& system, const loop::Isotropy& isotropy, const loop::Loop& start,
              const LocusTest& test, const LocusOptions& options)
      : _system(system), _test(test), _options(options), _base(start), _isotropy(isotropy) {
    const FamilyOf family{_system, _base, _isotropy, 2};
    if (const std::string why = CollocationProblem::obstacle(family, options.branch.cutoff_to); !why.empty())
      throw core::InputError(
          fmt::format("loci are solved for by collocation, which does not apply to orbits of {} with "
                      "the isotropy `{}`: {}",
                      system.info().name, loop::to_text(isotropy), why));
    _problem.emplace(family, _options.branch, _state);
  }

  Locus follow(const loop::Tangent& family, int side) {
    if (!begin(family, side)) return std::move(_locus);
    double length = first_step * _options.largest_step;
    while (!ended()) {
      if (static_cast<int>(_locus.points.size()) >= _options.branch.step_limit)
        end(EndReason::step_limit, fmt::format("{} points", _locus.points.size()));
      else if (!(length >= least_step * _options.largest_step))
        end(_why.first, fmt::format("at {} after {} points: {}", place_text(_system, _last.loop), _locus.points.size(),
                                    _why.second));
      if (ended()) break;
      std::optional<Solved> next = solve(length);
      if (!next || turns_too_far(*next)) {
        if (!next || !turn_to_curve()) length *= 0.5;
        continue;
      }
      const double wanted = _options.branch.prediction_error * std::min(1.0, _state.amplitude);
      const double after = next_step_length(length, next->error, wanted, static_cast<int>(_points.size()) - 1);
      accept(std::move(*next), length);
      length = std::min(after, _options.largest_step);
    }
    return std::move(_locus);
  }

 private:
  /// An orbit of the surface near the curve.
  struct Solved {
    Trial trial;
    Vector along, across;  // directions under whose conditions it was found
    double error = 0.0;    // of the prediction
    double slope = 0.0;    // of the test function across the curve
  };
  struct Last {
    Vector values;
    loop::Loop loop;
    Vector along, across;  // unit, orthogonal: they span the surface there
    double slope = 0.0;
    Vector still;       // of folds: the direction in which the two quantities rest
    double turn = 0.0;  // and how the test function changes along it
  };
  struct Kept {
    Last last;
    std::vector<TracePoint> points;
  };

  [[nodiscard]] double product(const Vector& a, const Vector& b) {
    const Vector zero(a.size(), 0.0);
    Vector at_a = a;  // changes of T count in units of the last point's
    Vector at_zero = zero;
    const std::size_t period = _problem->scalars_at();
    at_a[period] += _last.values[period];
    at_zero[period] += _last.values[period];
    return _problem->product(at_a, at_zero, b, zero);
  }
  void normalize(Vector& v) {
    const double length = std::sqrt(product(v, v));
    for (double& x : v) x /= length;
  }

  void end(EndReason reason, std::string detail) { _locus.ending = {reason, std::move(detail)}; }
  [[nodiscard]] bool ended() const { return !_locus.ending.detail.empty(); }

  /// More harmonics for everything that is kept; false where the options allow none.
  bool refine() {
    const std::optional<Resolution> finer = _problem->next_resolution(_options.branch.cutoff_to);
    if (!finer) {
      _why = {EndReason::cutoff_limit, fmt::format("the next orbit needs more than K = {}", _options.branch.cutoff_to)};
      return false;
    }
    const PointProblem::Transfer transfer = _problem->resolve(*finer);
    std::vector<Vector*> values;
    for (Kept* kept : {&_before, &_after}) {
      for (TracePoint& point : kept->points) values.push_back(&point.values);
      for (Vector* v : {&kept->last.values, &kept->last.along, &kept->last.across, &kept->last.still})
        values.push_back(v);
    }
    for (TracePoint& point : _points) values.push_back(&point.values);
    for (Vector* v : {&_last.values, &_last.along, &_last.across, &_last.still}) values.push_back(v);
    for (Vector* v : values)
      if (!v->empty()) *v = transfer(*v);
    return true;
  }

  std::optional<Trial> correct(const Prediction& prediction) {
    if (_options.before_each) _options.before_each();
    Trial trial = _problem->correct(prediction, _conditions);
    _needs_more = trial.converged ? !_problem->resolved(trial) : trial.under_resolved;
    if (_needs_more) return std::nullopt;
    if (!trial.is_orbit) {
      _why = {EndReason::failure, trial.reason};
      return std::nullopt;
    }
    return trial;
  }

  /// The test function at an orbit found under the conditions of `prediction`.
  double value(const Trial& trial, const Prediction& prediction) {
    try {
      if (_test.value) return _test.value(trial.loop);
      const auto [a, b] = images(trial, prediction);
      return a[0] * b[1] - a[1] * b[0];
    } catch (const core::NumericalError& error) {
      _why = {EndReason::failure, error.what()};
      return nan;
    }
  }

  [[nodiscard]] std::array<std::array<double, 2>, 2> images(const Trial& trial, const Prediction& prediction) {
    std::array<Vector, 2> span = _problem->surface_at(trial.values, prediction);
    const auto image = [&](Vector& direction) {
      normalize(direction);
      return _test.projection(trial.loop, _problem->change_of(direction, trial.loop));
    };
    return {image(span[0]), image(span[1])};
  }

  /// The start on the surface, which way the curve leaves it, and how the test function changes across.
  bool begin(const loop::Tangent& family, int side) {
    _state.amplitude = extent_of(_base.winding, loop::rms_amplitude(_base));
    _state.held_energy = energy_of(_system, _base);
    _problem->resolve(_problem->resolution_for(_base.cutoff, _base.time_map, _options.branch.cutoff_to));
    Prediction at;
    std::optional<Trial> trial;
    do {
      at = {_problem->from_loop(_base), _problem->from_change(loop::perturbation(_base, family)), 1};
      for (std::size_t n = 0; n < family.scalars.size(); ++n)
        at.tangent[_problem->scalars_at() + n] += family.scalars[n];
      at.across.assign(at.values.size(), 0.0);
      at.across[last_parameter()] = 1.0;
      _conditions = _problem->conditions_at(at);
      trial = correct(at);
    } while (!trial && _needs_more && refine());
    if (!trial) return end(_why.first, fmt::format("at the start: {}", _why.second)), false;
    _last.values = trial->values;
    _last.loop = trial->loop;
    try {
      take_plane(at);
      const double a = change_along(_last.along);
      const double b = change_along(_last.across);
      const double slope = std::hypot(a, b);
      if (!(slope > 0.0))
        return end(EndReason::failure,
                   fmt::format("the test function does not change about the start: {}", _why.second)),
               false;
      turn_plane({a / slope, b / slope}, side);
      _last.slope = _test.projection ? -side * slope : slope;  // a determinant knows how the two directions are turned
      take_turn(*trial);
    } catch (const core::NumericalError& error) {
      return end(EndReason::failure, fmt::format("at the start: {}", error.what())), false;
    }
    _points = {{_last.values, 0.0}};
    return true;
  }

  /// Orthonormal directions in the surface at the last point, the first as near to `near.tangent` as can be.
  void take_plane(const Prediction& near) {
    std::array<Vector, 2> span = _problem->surface_at(_last.values, near);
    normalize(span[0]);
    add(span[1], -product(span[1], span[0]), span[0]);
    normalize(span[1]);
    _last.along = std::move(span[0]);
    _last.across = std::move(span[1]);
  }

  /// How the test function changes along a direction in the plane of the last point.
  double change_along(const Vector& direction) {
    const Prediction here{_last.values, _last.along, 1, _last.across};
    _conditions = _problem->conditions_at(here);
    double change = 0.0;
    for (const double sign : {1.0, -1.0}) {
      Prediction there = here;
      add(there.values, sign * difference, direction);
      const std::optional<Trial> orbit = correct(there);
      change += orbit ? sign * value(*orbit, there) : nan;
    }
    return change / (2.0 * difference);
  }

  /// The direction across becomes this one, in those that there were; the way is orthogonal to it, to one side.
  void turn_plane(const std::array<double, 2>& to, int side) {
    Vector along(_last.values.size(), 0.0);
    Vector across(_last.values.size(), 0.0);
    add(along, -side * to[1], _last.along);
    add(along, side * to[0], _last.across);
    add(across, to[0], _last.along);
    add(across, to[1], _last.across);
    _last.along = std::move(along);
    _last.across = std::move(across);
  }

  /// Where the prediction's direction, extrapolated from points before, is not the curve's: turns the plane of the last
  /// point to where the test function does not change, and forgets those before. False if that is done already.
  bool turn_to_curve() {
    if (_points.size() < 2) return false;
    const double a = change_along(_last.along);
    const double b = change_along(_last.across);
    const double slope = std::copysign(std::hypot(a, b), _last.slope);
    if (!(std::abs(slope) > 0.0)) return false;
    turn_plane({a / slope, b / slope}, -1);
    _last.slope = slope;
    _points.erase(_points.begin(), _points.end() - 1);
    return true;
  }

  /// At a fold: the direction in which neither of the two quantities changes, and how the test function changes along
  /// it. The curve runs along it where that is zero.
  void take_turn(const Trial& trial) {
    if (!_test.projection) return;
    const auto [a, b] = images(trial, {_last.values, _last.along, 1, _last.across});
    const std::size_t larger = std::hypot(a[0], b[0]) > std::hypot(a[1], b[1]) ? 0 : 1;
    const Vector before = std::move(_last.still);
    _last.still.assign(_last.values.size(), 0.0);
    add(_last.still, -b[larger], _last.along);
    add(_last.still, a[larger], _last.across);
    normalize(_last.still);
    if (!before.empty() && product(before, _last.still) < 0.0)
      for (double& x : _last.still) x = -x;
    _last.turn = change_along(_last.still);
  }

  [[nodiscard]] std::size_t last_parameter() { return _problem->scalars_at() + _system.family_scalars().free.size(); }

  /// The point of the curve at a length from the last one.
  std::optional<Solved> solve(double length) {
    std::optional<Solved> found;
    do {
      _needs_more = false;
      found = try_to_solve(length);
    } while (!found && _needs_more && refine());
    return found;
  }

  std::optional<Solved> try_to_solve(double length) {
    Solved out;
    Prediction guess;
    if (_points.size() > 1) {
      guess = extrapolate(_points, order, _points.back().parameter + length);
    } else {
      guess = {_last.values, _last.along, 1};
      add(guess.values, length, _last.along);
    }
    _problem->settle(guess, _last.values);
    normalize(guess.tangent);
    // Across: in the surface's plane at the last point, orthogonal to the way.
    const double a = product(guess.tangent, _last.along);
    const double b = product(guess.tangent, _last.across);
    guess.across.assign(guess.values.size(), 0.0);
    add(guess.across, -b, _last.along);
    add(guess.across, a, _last.across);
    normalize(guess.across);
    _conditions = _problem->conditions_at(guess);
    std::optional<Trial> last;
    double last_place = nan;
    const auto test_at = [&](double place) {
      Prediction there = guess;
      add(there.values, place, guess.across);
      last = correct(there);
      last_place = place;
      return last ? value(*last, there) : nan;
    };
    const double here = test_at(0.0);
    if (!last || std::isnan(here)) return std::nullopt;
    const double wanted = _options.branch.prediction_error;
    double estimate = -here / _last.slope;
    if (std::abs(estimate) < least_estimate * wanted) estimate = std::copysign(least_estimate * wanted, estimate);
    double place = 0.0;
    out.slope = _last.slope;
    if (here != 0.0) {
      std::optional<numerics::Located> zero;
      const loop::Loop middle = last->loop;
      for (const double factor : brackets) {
        if (factor < 0.0 && !arrival_between(_system, _test, _locus.points, _last.loop, middle)) break;
        const numerics::Place from{0.0, here};
        const numerics::Place to{factor * estimate, test_at(factor * estimate)};
        if (!last || std::isnan(to.value)) return std::nullopt;
        out.slope = (to.value - from.value) / to.position;
        if (to.value * here > 0.0) continue;
        zero = to.position > 0.0 ? numerics::locate_root(test_at, from, to, place_tolerance)
                                 : numerics::locate_root(test_at, to, from, place_tolerance);
        break;
      }
      if (!zero) {
        if (!_needs_more) _why = {EndReason::failure, "the test function has no zero beside the prediction"};
        return std::nullopt;
      }
      place = zero->position;
    }
    if (place != last_place) (void)test_at(place);
    if (!last) return std::nullopt;
    out.error = std::abs(place);
    out.along = std::move(guess.tangent);
    out.across = std::move(guess.across);
    out.trial = std::move(*last);
    return out;
  }

  [[nodiscard]] bool turns_too_far(const Solved& next) {
    Vector way = next.trial.values;
    add(way, -1.0, _last.values);
    const double length = std::sqrt(product(way, way));
    const double cosine = product(way, _last.along) / length;
    if (cosine >= _options.branch.least_cosine) return false;
    _why = {EndReason::failure, "the curve turns too far in one step"};
    return true;
  }

  /// What lies between the last point and this one, a step of `length` further, then itself, or where a limit cuts it.
  void accept(Solved next, double length) {
    _before = {_last, _points};
    double reach = length;
    if (std::optional<std::pair<Ending, double>> limit = limit_within(next.trial.loop, length)) {
      _locus.ending = std::move(limit->first);
      reach = limit->second;
    }
    const auto met = arrival_between(_system, _test, _locus.points, _last.loop, next.trial.loop);
    if (met && met->second * length < reach) return end(met->first.reason, met->first.detail);
    // Returns and cusps lie in their order along the curve.
    std::vector<std::pair<double, LocusPoint>> between;
    const auto off = [this](const loop::Loop& loop) { return loop.parameters.back() - _base.parameters.back(); };
    if (!_locus.points.empty() && off(_last.loop) * off(next.trial.loop) < 0.0)
      if (auto at = place_where([&](const Last& there) { return off(there.loop); }, reach, false))
        between.emplace_back(at->first, LocusPoint{std::move(at->second), 0.0, false, true});
    if (reach != length || next.trial.values.size() != _last.values.size()) {
      std::optional<Solved> again = solve(reach);
      if (!again) return end(_why.first, "no orbit at the end of the last step: " + _why.second);
      next = std::move(*again);
    }
    move_to(std::move(next), true);
    _after = {_last, _points};
    if (_test.projection && _before.last.turn * _last.turn < 0.0)
      if (auto at = place_where([](const Last& there) { return there.turn; }, reach, true))
        between.emplace_back(at->first, LocusPoint{std::move(at->second), 0.0, true, false});
    _last = _after.last;
    _points = _after.points;
    std::sort(between.begin(), between.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const double from = _before.points.back().parameter;
    const double whole = _points.back().parameter - from;
    for (auto& [at, point] : between) {
      point.arclength = from + at / reach * whole;
      const bool is_start = point.is_return && closes(point.loop);
      _locus.points.push_back(std::move(point));
      if (is_start) return end(EndReason::closed_loop, "back at the start");
    }
    _locus.points.push_back({_last.loop, _points.back().parameter});
  }

  [[nodiscard]] bool closes(const loop::Loop& loop) {
    return distance_between_orbits(_system, _base, loop) < closed * _points.back().parameter;
  }

  void go_back() {
    _last = _before.last;
    _points = _before.points;
  }

  /// The point becomes the last one; its plane is needed for what is beyond it, and for folds.
  void move_to(Solved next, bool with_plane) {
    Vector way = next.trial.values;
    add(way, -1.0, _last.values);
    const double length = std::sqrt(product(way, way));
    const Vector across = _last.across;
    _points.push_back({next.trial.values, _points.back().parameter + length});
    if (_points.size() > static_cast<std::size_t>(order) + 1) _points.erase(_points.begin());
    _last.values = next.trial.values;
    _last.loop = next.trial.loop;
    if (!with_plane) return;
    _state.amplitude = extent_of(next.trial.loop.winding, loop::rms_amplitude(next.trial.loop));
    _last.slope = next.slope;
    try {
      take_plane({_last.values, next.along, 1, next.across});
      if (product(_last.across, across) < 0.0) {
        for (double& x : _last.across) x = -x;
        _last.slope = -_last.slope;
      }
      take_turn(next.trial);
    } catch (const core::NumericalError& error) {
      if (!ended()) _locus.ending = {EndReason::failure, error.what()};
    }
  }

  /// Where a function of the curve's points vanishes within the step of `reach` from the one before, and the orbit
  /// there. Leaves the last point as it was before the step.
  std::optional<std::pair<double, loop::Loop>> place_where(const std::function<double(const Last&)>& function,
                                                           double reach, bool with_plane) {
    const auto at = [&](double length) {
      go_back();
      if (length == 0.0) return function(_last);
      std::optional<Solved> there = solve(length);
      if (!there) return nan;
      move_to(std::move(*there), with_plane);
      return function(_last);
    };
    const auto place = numerics::locate_root(at, 0.0, reach, place_tolerance);
    std::optional<std::pair<double, loop::Loop>> found;
    if (place && !std::isnan(at(place->position))) found = {place->position, _last.loop};
    go_back();
    return found;
  }

  /// The first limit that the step to `loop` passes, and where.
  std::optional<std::pair<Ending, double>> limit_within(const loop::Loop& loop, double length) {
    std::optional<std::pair<Ending, double>> first;
    for (const LocusLimit& limit : _limits) {
      if (!(limit.off(_last.loop) * limit.off(loop) < 0.0)) continue;
      const auto place = place_where([&](const Last& there) { return limit.off(there.loop); }, length, false);
      if (place && (!first || place->first < first->second)) first = {limit.ending, place->first};
    }
    return first;
  }

  const systems::System& _system;
  const LocusTest& _test;
  const LocusOptions& _options;
  std::vector<LocusLimit> _limits = limits_of(_system, _options, _test);
  loop::Loop _base;
  loop::Isotropy _isotropy;
  ProblemState _state;
  std::optional<CollocationProblem> _problem;
  Vector _conditions;
  std::vector<TracePoint> _points;
  Last _last;
  Kept _before, _after;  // the step that is taken
  bool _needs_more = false;
  std::pair<EndReason, std::string> _why{EndReason::failure, "no step succeeds"};
  Locus _locus;
};

}  // namespace

Locus follow_locus(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                   const loop::Loop& start, const loop::Tangent& family, const LocusTest& test, int side,
                   const LocusOptions& options) {
  return LocusTracer(*system, isotropy, start, test, options).follow(family, side);
}

}  // namespace orbweaver::continuation
