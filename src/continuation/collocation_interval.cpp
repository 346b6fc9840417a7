#include <algorithm>
#include <cmath>

#include "cell_counts.hpp"
#include "curve_interval.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"
#include "point_corrector.hpp"

namespace orbweaver::continuation {

namespace {

using equations::Collocation;

class CollocationInterval final : public CurveInterval {
 public:
  CollocationInterval(const IntervalOf& of, loop::FundamentalDomain domain)
      : _system(of.system),
        _options(of.options),
        _from(of.known[of.last - 1].position),
        _to(of.known[of.last].position),
        _points(_system, Start{of.known[of.last].loop, {}, of.isotropy}, std::move(domain), _options, _frontier) {
    const loop::Loop& last = of.known[of.last].loop;
    _frontier.amplitude = loop::rms_amplitude(last);
    std::vector<loop::Loop> loops;
    int cutoff = 0;
    for (const FamilyCurve::Known& k : of.known) {
      loops.push_back(under_map(k.loop, last.time_map, 0));
      cutoff = std::max(cutoff, loops.back().cutoff);
    }
    _points.set_grid(cell_counts::at_least_for_cutoff(_points.domain(), cutoff), last.time_map);
    for (std::size_t n = 0; n < loops.size(); ++n) {
      TracePoint point{std::vector<double>(static_cast<std::size_t>(equations().size()), 0.0), of.known[n].position};
      equations().from_loop(loops[n], point.values.data());
      if (n + 1 == of.last) _first = points().size();
      if (n == of.last) _last = points().size();
      points().push_back(std::move(point));
    }
  }

  std::optional<CurvePoint> at(double position, bool with_tangent) override {
    const auto known = std::find_if(_found.begin(), _found.end(), [&](const CurvePoint& point) {
      return point.position == position && (!with_tangent || !point.tangent.empty());
    });
    if (known != _found.end()) return *known;
    std::optional<Trial> trial = solve(position);
    if (!trial) {
      _frontier.trace.factor_point.clear();
      trial = solve(position);
    }
    if (!trial) return std::nullopt;
    CurvePoint found{position, _points.modes(), {}};
    if (with_tangent) set_tangent(trial->values, found);
    points().push_back({std::move(trial->values), position});
    _found.push_back(found);
    return found;
  }

 private:
  [[nodiscard]] Collocation& equations() { return _points.equations(); }
  [[nodiscard]] std::vector<TracePoint>& points() { return _frontier.trace.points; }

  std::optional<Trial> solve(double position) {
    while (true) {
      const Prediction prediction = prediction_at(position);
      // Conditions of the interval, not of the guess: the orbit must not depend on how it is found.
      const std::vector<double> weights = _points.conditions_at({points()[_first].values, prediction.tangent, 1});
      Trial trial = _points.correct(prediction, weights);
      if (!trial.converged || slipped(trial, prediction)) return std::nullopt;
      if (_points.resolved(trial)) {
        if (!trial.accepted()) return std::nullopt;
        return trial;
      }
      // The time map stays: the chord is measured under it.
      const int cells = cell_counts::next(equations().cells());
      if (_points.cutoff_of(cells) > 2 * _options.cutoff_to) return std::nullopt;
      _points.regrid({cells, equations().time_map()});
    }
  }

  /// True if the corrector has gone far from where the family is expected: onto another one.
  [[nodiscard]] bool slipped(const Trial& trial, const Prediction& prediction) {
    const std::vector<double>& first = points()[_first].values;
    const std::vector<double>& last = points()[_last].values;
    const std::vector<double>& guess = prediction.values;
    return _points.product(trial.values, guess, trial.values, guess) >
           largest_correction * largest_correction * _points.product(last, first, last, first);
  }

  /// On the polynomial through the nearest points, moved along the chord to its share of it.
  Prediction prediction_at(double position) {
    std::vector<double> positions;
    for (const TracePoint& point : points()) positions.push_back(point.parameter);
    const std::vector<double> weights = lagrange_weights(positions, position, _to - _from);
    const std::vector<double>& first = points()[_first].values;
    const std::vector<double>& last = points()[_last].values;
    Prediction out;
    out.values.assign(first.size(), 0.0);
    out.tangent.resize(first.size());
    for (std::size_t p = 0; p < weights.size(); ++p)
      if (weights[p] != 0.0)
        for (std::size_t n = 0; n < out.values.size(); ++n) out.values[n] += weights[p] * points()[p].values[n];
    for (std::size_t n = 0; n < first.size(); ++n) out.tangent[n] = last[n] - first[n];
    if (equations().borders() > 1) {
      const auto unfolding = static_cast<std::size_t>(equations().period_at() + 1);
      out.values[unfolding] = out.tangent[unfolding] = 0.0;
    }
    _points.hold_phase(out, first);
    std::vector<double> end = first;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += out.tangent[n];
    const double share = (position - _from) / (_to - _from);
    const double off = share - _points.product(out.values, first, end, first) / _points.product(end, first, end, first);
    for (std::size_t n = 0; n < end.size(); ++n) out.values[n] += off * out.tangent[n];
    return out;
  }

  void set_tangent(const std::vector<double>& values, CurvePoint& point) {
    Prediction prediction = prediction_at(point.position);
    Collocation& own = equations();
    Collocation e(_system, _points.domain(), own.centre(), own.winding(), own.cells(), own.time_map());
    e.set_conditions(_points.conditions_at(prediction), values);
    std::vector<double> tangent = prediction.tangent;
    try {
      tangent = equations::family_direction(e, values);
    } catch (const core::NumericalError&) {
      // Next to a crossing the linear system is singular: the chord's direction stands.
    }
    point.tangent.modes.resize(point.loop.modes.size());
    e.grid().to_modes(tangent.data(), point.tangent.modes.data());
    point.tangent.scalars = {tangent[static_cast<std::size_t>(e.period_at())]};
    point.tangent.normalize();
  }

  const systems::System& _system;
  const Options& _options;
  double _from;
  double _to;
  Frontier _frontier;
  PointCorrector _points;
  std::size_t _first = 0;  // of the interval, among the points
  std::size_t _last = 0;
  std::vector<CurvePoint> _found;
};

}  // namespace

std::unique_ptr<CurveInterval> make_collocation_interval(const IntervalOf& of) {
  loop::FundamentalDomain domain = loop::fundamental_domain(of.isotropy, of.system.dimension());
  if (!domain.expresses(of.isotropy) || !Collocation::applies(of.system, domain)) return nullptr;
  return std::make_unique<CollocationInterval>(of, std::move(domain));
}

}  // namespace orbweaver::continuation
