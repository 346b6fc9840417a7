#include "point_corrector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::continuation {

using equations::Collocation;

std::string Trial::why() const {
  if (!converged) return reason;
  return fmt::format("sqrt(loss) = {:.3g} at rounding, wanted {:.3g}: the tolerance is out of reach", quality.loss_rms,
                     threshold);
}

PointCorrector::PointCorrector(const systems::System& system, const Start& start, loop::FundamentalDomain domain,
                               const Options& options, Frontier& frontier)
    : _system(system),
      _domain(std::move(domain)),
      _isotropy(start.isotropy),
      _centre(start.base.modes.begin(), start.base.modes.begin() + start.base.dimension),
      _winding(start.base.winding),
      _options(options),
      _frontier(frontier) {}

void PointCorrector::set_grid(int cells, const loop::TimeMap& map) {
  _equations = std::make_unique<Collocation>(_system, _domain, _centre, _winding, cells, map);
  state().cells = cells;
  state().time_map = map;
  state().factor_point.clear();
}

Collocation& PointCorrector::equations() {
  if (!_equations) {
    const std::vector<double> point = state().factor_point;
    const std::vector<double> conditions = state().factor_conditions;
    set_grid(state().cells, state().time_map);
    if (!point.empty()) {
      _equations->set_conditions(conditions, point);
      _equations->factor(point.data());
      state().factor_point = point;
    }
  }
  return *_equations;
}

std::vector<double> PointCorrector::conditions_at(const Prediction& prediction) {
  Collocation& e = equations();
  const int stride = e.grid().stride();
  const auto size = static_cast<std::size_t>(e.size());
  const std::vector<double>& share = e.node_weights();
  std::vector<double> weights(static_cast<std::size_t>(e.borders()) * size, 0.0);
  double square = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      weights[n] = share[static_cast<std::size_t>(j)] * prediction.tangent[n];
      square += weights[n] * prediction.tangent[n];
    }
  const auto at_period = static_cast<std::size_t>(e.period_at());
  const double unit = period_unit(prediction.values[at_period]);
  weights[at_period] = prediction.tangent[at_period] / (unit * unit);
  square += weights[at_period] * prediction.tangent[at_period];
  for (std::size_t n = 0; n < size; ++n) weights[n] /= std::sqrt(square);
  if (e.borders() > 1) phase_condition(prediction, weights);
  return weights;
}

void PointCorrector::hold_phase(Prediction& prediction, const std::vector<double>& last) {
  Collocation& e = equations();
  if (e.borders() < 2) return;
  const int stride = e.grid().stride();
  std::vector<double> z(static_cast<std::size_t>(e.dimension() * stride));
  std::vector<double> slope(z.size());
  e.grid().at_nodes(last.data(), z.data(), slope.data());
  const std::vector<double>& shift = slope;  // of z instead of y: near enough to move along
  double square = 0.0;
  double moved = 0.0;
  double turned = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      const double weight = e.node_weights()[static_cast<std::size_t>(j)] * slope[n];
      square += weight * shift[n];
      moved += weight * (prediction.values[n] - last[n]);
      turned += weight * prediction.tangent[n];
    }
  if (!(square > 1e-16)) return;  // at an equilibrium there is no phase
  for (std::size_t n = 0; n < shift.size(); ++n) {
    prediction.values[n] -= moved / square * shift[n];
    prediction.tangent[n] -= turned / square * shift[n];
  }
}

void PointCorrector::phase_condition(const Prediction& prediction, std::vector<double>& weights) {
  Collocation& e = equations();
  const int stride = e.grid().stride();
  const auto size = static_cast<std::size_t>(e.size());
  std::vector<double> z(static_cast<std::size_t>(e.dimension() * stride));
  std::vector<double> slope(z.size());
  e.grid().at_nodes(prediction.values.data(), z.data(), slope.data());
  double square = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      weights[size + n] = e.node_weights()[static_cast<std::size_t>(j)] * slope[n];
      square += weights[size + n] * slope[n];
    }
  for (std::size_t n = size; n < 2 * size; ++n) weights[n] /= std::sqrt(square);
}

Trial PointCorrector::correct(Prediction prediction, const std::vector<double>& weights) {
  Collocation& e = equations();
  e.set_conditions(weights, prediction.values);
  Trial trial;
  trial.order = prediction.order;
  trial.values = std::move(prediction.values);
  if (!(trial.values[static_cast<std::size_t>(e.period_at())] > 0.0)) {
    trial.reason = "the predicted period is not positive";
    return trial;
  }
  equations::AndersonSolver::Options solver;
  // At a small amplitude A the equations see a change of T only A times.
  const double amplitude = std::min(1.0, std::max(_frontier.amplitude, 1e-300));
  double size = amplitude;
  for (const double c : e.centre()) size = std::max(size, std::abs(c));
  solver.tolerance = 1e-2 * _options.corrector.tolerance * amplitude;
  solver.rounding = std::max(0.3 * solver.tolerance, 50.0 * std::numeric_limits<double>::epsilon() * size);
  solver.scaled_from = e.period_at();
  solver.border_scale = amplitude;
  const std::vector<double> predicted = trial.values;
  try {
    auto result = _solver.solve(e, trial.values, !state().factor_point.empty(), solver);
    trial.iterations = result.iterations;
    trial.prediction_error = result.first_change;
    trial.converged = result.converged;
    if (result.factored) {
      state().factor_point = std::move(result.factor_point);
      state().factor_conditions = weights;
    }
    if (!result.converged) {
      state().factor_point.clear();
      trial.reason = result.finite ? fmt::format("no convergence in {} iterations, the last change {:.2g}",
                                                 result.iterations, result.last_change)
                                   : not_finite_at(trial.values, predicted);
    }
  } catch (const core::NumericalError& error) {
    state().factor_point.clear();
    trial.converged = false;
    trial.reason = error.what();
  }
  if (trial.converged) judge(trial);
  return trial;
}

/// Accepts by the loss over the whole loop.
void PointCorrector::judge(Trial& trial) {
  Collocation& e = equations();
  trial.quality = e.quality(trial.values.data());
  double centre = 0.0;
  for (const double c : e.centre()) centre += c * c;
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(centre) * e.field_jacobian_rms();
  trial.threshold = std::max(_options.corrector.tolerance * std::min(1.0, trial.quality.speed_rms), rounding);
  if (!(trial.values[static_cast<std::size_t>(e.period_at())] > 0.0)) {
    trial.converged = false;
    trial.reason = "the period is not positive";
  } else if (!std::isfinite(trial.quality.loss_rms)) {
    trial.converged = false;
    trial.reason = not_finite_at(trial.values, trial.values);
  }
}

/// The sentence that the loss has for a field that is not finite.
std::string PointCorrector::not_finite_at(const std::vector<double>& values, const std::vector<double>& predicted) {
  for (const std::vector<double>* point : {&predicted, &values}) {
    const bool finite = std::all_of(point->begin(), point->end(), [](double v) { return std::isfinite(v); });
    if (!finite) continue;
    try {
      const loss::Linearization probe(_system, equations().to_loop(point->data()),
                                      loss::Linearization::Order::jacobian);
    } catch (const core::NotFiniteError& error) {
      return error.what();
    }
  }
  return "the correction met numbers that are not finite";
}

bool PointCorrector::inverted(const Trial& trial, const std::vector<double>& last) {
  Collocation& e = equations();
  double product = 0.0;
  for (int i = 0; i < e.dimension(); ++i) {
    double sum_a = 0.0;
    double sum_b = 0.0;
    double sum_ab = 0.0;
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      const double share = e.node_weights()[static_cast<std::size_t>(j)];
      sum_a += share * last[n];
      sum_b += share * trial.values[n];
      sum_ab += share * last[n] * trial.values[n];
    }
    product += e.keeps_mean(i) ? sum_ab - sum_a * sum_b : sum_ab;
  }
  return product < 0.0;
}

double PointCorrector::product(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                               const std::vector<double>& d) {
  Collocation& e = equations();
  double sum = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      sum += e.node_weights()[static_cast<std::size_t>(j)] * (a[n] - b[n]) * (c[n] - d[n]);
    }
  const auto at_period = static_cast<std::size_t>(e.period_at());
  const double unit = period_unit(b[at_period]);
  return sum + (a[at_period] - b[at_period]) * (c[at_period] - d[at_period]) / (unit * unit);
}

/// At a small amplitude the period is known to eps / amplitude only: it must not decide how far a step went.
double PointCorrector::period_unit(double period) const { return period / std::min(1.0, _frontier.amplitude); }

double PointCorrector::tail_limit(const Trial& trial) const {
  const double rounding = std::numeric_limits<double>::epsilon() * trial.quality.size;
  return std::max(_options.tail_tolerance * std::min(1.0, trial.quality.amplitude), rounding);
}

bool PointCorrector::resolved(const Trial& trial) {
  _modes = equations().to_loop(trial.values.data());
  const double last = loop::tail(_modes);
  if (last > tail_limit(trial)) return false;
  // A tail of the size of the modes' own rounding says nothing of the resolution.
  if (last <= 4.0 * std::numeric_limits<double>::epsilon() * trial.quality.size) return true;
  const double truncation = 2.0 * std::numbers::pi / _modes.period * _modes.cutoff * last;
  return trial.quality.loss_rms < trial.threshold || truncation < 1e-2 * trial.quality.loss_rms;
}

std::optional<Resolution> PointCorrector::finer(const Trial& trial) {
  // At most one new map a step: the next fit would be to the same orbit.
  if (_options.fit_time_map && state().time_map == _frontier.orbit.loop.time_map)
    if (std::optional<Resolution> general = remapped(trial)) return general;
  return finer_resolution(equations(), trial.values, tail_limit(trial), _options.cutoff_to, _options.fit_time_map);
}

std::optional<Resolution> PointCorrector::remapped(const Trial& of) {
  const Collocation& e = equations();
  const std::vector<double>& settled = state().points.back().values;
  // What the loss allows the first harmonic that is left out, at the present cutoff.
  const double period = settled[static_cast<std::size_t>(e.period_at())];
  const double allowed = 0.3 * of.threshold * period / (2.0 * std::numbers::pi * e.grid().cutoff());
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * of.quality.size;
  if (e.cells() < _options.general_map_cells) return std::nullopt;
  return general_resolution(e, settled, _isotropy, std::max(std::min(tail_limit(of), allowed), rounding),
                            _options.cutoff_from);
}

void PointCorrector::regrid(const Resolution& to) {
  const std::unique_ptr<Collocation> from = std::move(_equations);
  set_grid(to.cells, to.time_map);
  std::vector<TracePoint>& points = state().points;
  for (TracePoint& point : points) point.values = _equations->resampled(*from, point.values);
  if (points.size() < 2 || from->time_map() == to.time_map || to.time_map.coefficients.empty()) return;
  // Lengths are means over s: a general map measures them anew (a somewhat sharper pulse changes them little).
  const double last = points.back().parameter - points[points.size() - 2].parameter;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const std::vector<double>& a = points[n - 1].values;
    const std::vector<double>& b = points[n].values;
    points[n].parameter = points[n - 1].parameter + std::sqrt(product(b, a, b, a));
  }
  _frontier.next_length *= (points.back().parameter - points[points.size() - 2].parameter) / last;
}

double PointCorrector::energy() const {
  const auto d = static_cast<std::size_t>(_modes.dimension);
  std::vector<double> z(_modes.modes.begin(), _modes.modes.begin() + _modes.dimension);
  for (int k = _modes.cutoff; k >= 1; --k)
    for (std::size_t i = 0; i < d; ++i) z[i] += _modes.cosine(k, static_cast<int>(i));
  return energy_at(_system, z);
}

}  // namespace orbweaver::continuation
