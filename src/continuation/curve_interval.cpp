#include "curve_interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "under_map.hpp"

namespace orbweaver::continuation {

namespace {

/// An orbit further than this from its prediction, in parts of the chord, belongs to another family.
constexpr double largest_correction = 0.2;
/// Nearest orbits that a prediction takes, a cubic, and how far apart in parts of the interval: at 1e-4 an orbit's
/// rounding is multiplied by 1e4, still below what the corrector removes.
constexpr std::size_t used_orbits = 4;
constexpr double apart = 1e-4;
/// Of the way to an orbit that is not found from its prediction, or far from it. Not measured.
constexpr int most_halvings = 4;
/// On such a way the correction may be this times as large as on the whole chord, in parts of the link's share of it:
/// several links must not add up to another family.
constexpr double reach_of_link = 4.0;

/// Up to four nodes, nearest to `position` first, well apart so that their rounding is not amplified: what is nearer
/// than `apart` of the interval's `length` is not.
std::vector<std::size_t> nodes_near(const std::vector<TracePoint>& points, double position, double length) {
  std::vector<std::size_t> nearest(points.size());
  std::iota(nearest.begin(), nearest.end(), std::size_t{0});
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(points[a].parameter - position) < std::abs(points[b].parameter - position);
  });
  std::vector<std::size_t> used;
  for (const std::size_t n : nearest) {
    const bool is_apart = std::all_of(used.begin(), used.end(), [&](std::size_t other) {
      return std::abs(points[n].parameter - points[other].parameter) > apart * length;
    });
    if (is_apart && used.size() < used_orbits) used.push_back(n);
  }
  return used;
}

}  // namespace

CurveInterval::CurveInterval(const systems::System& system, const loop::Isotropy& isotropy, const Options& options,
                             const std::vector<FamilyCurve::Known>& known, std::size_t last)
    : _options(options),
      _from(known[last - 1].position),
      _to(known[last].position),
      _problem(make_point_problem({system, known[last].loop, isotropy}, options, _state)) {
  const loop::Loop& end = known[last].loop;
  _state.amplitude = extent_of(end.winding, loop::rms_amplitude(end));
  _state.held_energy = energy_of(system, end);
  std::vector<loop::Loop> loops;
  int cutoff = 0;
  for (const FamilyCurve::Known& k : known) {
    loops.push_back(under_map(k.loop, end.time_map));
    cutoff = std::max(cutoff, loops.back().cutoff);
  }
  _problem->resolve(_problem->resolution_for(cutoff, end.time_map, std::numeric_limits<int>::max()));
  for (std::size_t n = 0; n < loops.size(); ++n) _points.push_back({_problem->from_loop(loops[n]), known[n].position});
  _first = last - 1;
  _last = last;
  _ends = {std::move(loops[_first]), std::move(loops[_last])};
}

std::optional<CurvePoint> CurveInterval::at(double position, bool with_tangent) {
  const auto known = std::find_if(_found.begin(), _found.end(), [&](const CurvePoint& point) {
    return point.position == position && (!with_tangent || !point.tangent.empty());
  });
  if (known != _found.end()) return *known;
  std::optional<Trial> trial = solve(position);
  if (!trial) {
    _state.factor_point.clear();
    trial = solve(position);
  }
  if (!trial) trial = known_at(position);
  if (!trial) trial = approach(position);
  // Near a place where two families meet the box scheme, whose phase is a little wrong, meets them elsewhere, and what
  // it stands for there is not the derivative at all.
  const equations::Preconditioner usual = _state.preconditioner;
  const bool is_by_gmres = !trial && !_is_refused && _problem->is_preconditioned();
  if (is_by_gmres) {
    _state.preconditioner = equations::Preconditioner::krylov;
    _state.factor_point.clear();
    trial = solve(position);
  }
  std::optional<CurvePoint> found;
  if (trial) found = taken(position, *std::move(trial), with_tangent);
  if (is_by_gmres) {
    _state.preconditioner = usual;
    _state.factor_point.clear();
  }
  return found;
}

CurvePoint CurveInterval::taken(double position, Trial trial, bool with_tangent) {
  CurvePoint found{position, std::move(trial.loop), {}};
  if (with_tangent) add_tangent(trial.values, found);
  _points.push_back({std::move(trial.values), position});
  _found.push_back(found);
  return found;
}

void CurveInterval::add_tangent(const std::vector<double>& values, CurvePoint& point) {
  const Prediction here = prediction_at(point.position);
  const std::vector<double> direction = _problem->direction_at(values, here);
  point.tangent = _problem->change_of(direction, point.loop);
  const double length = point.tangent.norm();
  point.tangent.normalize();
  // As positions are measured: all from the first orbit, in whose unit of the period the products are.
  const std::vector<double>& first = _points[_first].values;
  std::vector<double> moved = first;
  std::vector<double> end = first;
  for (std::size_t n = 0; n < end.size(); ++n) {
    moved[n] += direction[n];
    end[n] += here.tangent[n];
  }
  const double share =
      _problem->condition_product(moved, first, end, first) / _problem->condition_product(end, first, end, first);
  point.advance = share * (_to - _from) / length;
}

/// By orbits in between, each half way to the next, where the prediction from those around is too far off.
std::optional<Trial> CurveInterval::approach(double position) {
  const std::size_t count = _points.size();
  const bool was_refused = _is_refused;
  std::optional<Trial> trial = approach(position, most_halvings);
  _reach = 1.0;
  if (!trial) {
    _points.resize(count);
    _is_refused = was_refused;
  }
  return trial;
}

std::optional<Trial> CurveInterval::approach(double position, int halvings) {
  if (_is_refused || halvings == 0) return std::nullopt;
  const auto nearest = std::min_element(_points.begin(), _points.end(), [&](const TracePoint& a, const TracePoint& b) {
    return std::abs(a.parameter - position) < std::abs(b.parameter - position);
  });
  const double between = 0.5 * (nearest->parameter + position);
  const double reach = std::min(1.0, reach_of_link * std::abs(position - between) / (_to - _from));
  _reach = reach;
  std::optional<Trial> nearer = solve(between);
  if (!nearer) nearer = approach(between, halvings - 1);
  if (!nearer) return std::nullopt;
  _points.push_back({std::move(nearer->values), between});
  _reach = reach;
  return solve(position);
}

std::optional<Trial> CurveInterval::known_at(double position) const {
  for (const std::size_t n : {_first, _last})
    if (_points[n].parameter == position) {
      Trial trial;
      trial.values = _points[n].values;
      trial.loop = _ends[n - _first];
      return trial;
    }
  return std::nullopt;
}

std::optional<Trial> CurveInterval::solve(double position) {
  while (true) {
    const Prediction prediction = prediction_at(position);
    // Conditions of the interval, not of the guess: the orbit must not depend on how it is found.
    const std::vector<double> conditions = _problem->conditions_at({_points[_first].values, prediction.tangent, 1});
    Trial trial = _problem->correct(prediction, conditions);
    _is_refused = trial.is_refused;
    if (trial.converged && slipped(trial, prediction)) return std::nullopt;
    const bool unresolved = trial.converged ? !_problem->resolved(trial) : trial.under_resolved;
    if (!unresolved) return trial.is_orbit ? std::optional(std::move(trial)) : std::nullopt;
    // The time map stays: the chord is measured under it.
    const std::optional<Resolution> finer = _problem->next_resolution(2 * _options.cutoff_to);
    if (!finer) return std::nullopt;
    const PointProblem::Transfer transfer = _problem->resolve(*finer);
    for (TracePoint& point : _points) point.values = transfer(point.values);
  }
}

/// True if the corrector has gone far from where the family is expected: onto another one.
bool CurveInterval::slipped(const Trial& trial, const Prediction& prediction) {
  const std::vector<double>& first = _points[_first].values;
  const std::vector<double>& last = _points[_last].values;
  const std::vector<double>& guess = prediction.values;
  return _problem->product(trial.values, guess, trial.values, guess) >
         std::pow(_reach * largest_correction, 2) * _problem->product(last, first, last, first);
}

/// On the polynomial through the nearest points, moved along the chord to its share of it.
Prediction CurveInterval::prediction_at(double position) {
  const std::vector<std::size_t> used = nodes_near(_points, position, _to - _from);
  std::vector<double> positions;
  for (const std::size_t n : used) positions.push_back(_points[n].parameter);
  const std::vector<double> weights = numerics::lagrange_weights(positions, position).value;
  const std::vector<double>& first = _points[_first].values;
  const std::vector<double>& last = _points[_last].values;
  Prediction out;
  out.values.assign(first.size(), 0.0);
  out.tangent.resize(first.size());
  for (std::size_t p = 0; p < used.size(); ++p)
    for (std::size_t n = 0; n < out.values.size(); ++n) out.values[n] += weights[p] * _points[used[p]].values[n];
  for (std::size_t n = 0; n < first.size(); ++n) out.tangent[n] = last[n] - first[n];
  _problem->settle(out, first);
  std::vector<double> end = first;
  for (std::size_t n = 0; n < end.size(); ++n) end[n] += out.tangent[n];
  const double share = (position - _from) / (_to - _from);
  // In the product of the conditions, or the orbit would depend on the guess.
  const double off = share - _problem->condition_product(out.values, first, end, first) /
                                 _problem->condition_product(end, first, end, first);
  for (std::size_t n = 0; n < end.size(); ++n) out.values[n] += off * out.tangent[n];
  return out;
}

}  // namespace orbweaver::continuation
