#include "orbweaver/taylor/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "orbweaver/core/error.hpp"
#include "orbweaver/taylor/series.hpp"

namespace orbweaver::taylor {

namespace {

/// The quickest order for a tolerance eps is -ln(eps)/2: a step is then 1/e^2 of the radius of convergence (Jorba and
/// Zou 2005, section 3.2).
int quickest_order(double digits) {
  return std::max(4, static_cast<int>(std::ceil(0.5 * std::numbers::ln10 * digits)));
}

/// The component's, or the entry's of a transition, in log10.
double log_scale(const std::vector<double>& log_scales, std::size_t i) {
  const std::size_t d = log_scales.size();
  return i < d ? log_scales[i] : log_scales[(i - d) / d] - log_scales[(i - d) % d];
}

}  // namespace

template <class Real>
Flow<Real>::Flow(const systems::Formulas& formulas, const std::vector<Real>& parameters, const FlowOptions& options)
    : _formulas(formulas), _parameters(parameters), _options(options) {
  core::require(parameters.size() == formulas.parameters.size(), "one value a parameter");
  const auto d = static_cast<std::size_t>(formulas.dimension);
  core::require(options.scales.empty() || options.scales.size() == d, "one scale a coordinate");
  for (std::size_t i = 0; i < d; ++i)
    _log_scales.push_back(options.scales.empty() ? 0.0 : std::log10(options.scales[i]));
}

template <class Real>
Flow<Real>::~Flow() = default;

template <class Real>
Flow<Real>::Flow(Flow&&) noexcept = default;

template <class Real>
int Flow<Real>::order() const {
  return quickest_order(_options.digits) + _options.extra_order;
}

template <class Real>
void Flow<Real>::advance(std::vector<Real>& state, const Real& time) {
  if (!_state) _state = std::make_unique<Series<Real>>(_formulas.graph, _formulas.field, _parameters, order());
  std::vector<Real> none;
  run(*_state, state, none, time);
}

template <class Real>
void Flow<Real>::advance(std::vector<Real>& state, std::vector<Real>& transitions, const Real& time) {
  core::require(transitions.size() == state.size() * state.size(), "a square matrix of transitions");
  if (!_variational) {
    std::vector<int> outputs = _formulas.field;
    outputs.insert(outputs.end(), _formulas.variations.begin(), _formulas.variations.end());
    _variational = std::make_unique<Series<Real>>(_formulas.graph, outputs, _parameters, order());
  }
  run(*_variational, state, transitions, time);
}

template <class Real>
double Flow<Real>::log_norm(Series<Real>& series, int k, std::size_t from, std::size_t to) const {
  double norm = -std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i < to; ++i)
    norm = std::max(norm, numerics::log10_abs(series.own(i, k)) - log_scale(_log_scales, i));
  return norm;
}

template <class Real>
double Flow<Real>::step_size(Series<Real>& series, std::size_t size) const {
  const std::size_t d = _log_scales.size();
  double log_step = std::numeric_limits<double>::infinity();
  const double grown = size > d ? log_norm(series, 0, d, size) : 0.0;
  for (const int k : {series.order() - 1, series.order()}) {  // one of them may vanish by a symmetry
    log_step = std::min(log_step, (-_options.digits - log_norm(series, k, 0, d)) / k);
    if (size > d) log_step = std::min(log_step, (-_options.digits + grown - log_norm(series, k, d, size)) / k);
  }
  return std::pow(10.0, log_step);
}

template <class Real>
void Flow<Real>::run(Series<Real>& series, std::vector<Real>& state, std::vector<Real>& transitions, const Real& time) {
  using A = Arithmetic<Real>;
  core::require(state.size() == _log_scales.size(), "a state of another dimension");
  const std::size_t size = state.size() + transitions.size();
  Real remaining = Real();
  A::set(remaining, time);
  Real step = Real();
  for (long count = 0; !A::is_zero(remaining); ++count) {
    if (count >= _options.most_steps)
      throw core::NumericalError("a Taylor integration was given up: its steps become ever shorter");
    series.expand(state, transitions);
    for (std::size_t i = 0; i < size; ++i)
      if (!A::is_finite(series.own(i, series.order())))
        throw core::NotFiniteError("the Taylor series of the solution is not finite: a singularity of the field");
    const double rest = A::to_double(remaining);
    const double length = step_size(series, size);
    if (length >= std::abs(rest))
      A::set(step, remaining);
    else
      A::set(step, std::copysign(length, rest));
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t d = state.size();
      series.sum(i, step, i < d ? state[i] : transitions[i - d]);
    }
    A::subtract(remaining, remaining, step);
    ++_steps;
  }
}

namespace {

constexpr std::size_t width = ad::Lanes::width;

std::vector<ad::Lanes> in_all_lanes(const std::vector<double>& values) { return {values.begin(), values.end()}; }

}  // namespace

ManyFlows::ManyFlows(const systems::Formulas& formulas, const FlowOptions& options)
    : _options(options),
      _dimension(static_cast<std::size_t>(formulas.dimension)),
      _series(std::make_unique<Series<ad::Lanes>>(formulas.graph, formulas.field, in_all_lanes(formulas.values),
                                                  quickest_order(options.digits) + options.extra_order)) {
  core::require(options.scales.empty() || options.scales.size() == _dimension, "one scale a coordinate");
  for (std::size_t i = 0; i < _dimension; ++i) _scales.push_back(options.scales.empty() ? 1.0 : options.scales[i]);
}

ManyFlows::~ManyFlows() = default;
ManyFlows::ManyFlows(ManyFlows&&) noexcept = default;

double ManyFlows::step_size(std::size_t lane) const {
  const int order = _series->order();
  double log_step = std::numeric_limits<double>::infinity();
  for (const int k : {order - 1, order}) {  // one of them may vanish by a symmetry
    double norm = 0.0;
    for (std::size_t i = 0; i < _dimension; ++i) {
      const double term = std::abs(_series->own(i, k).packed[lane]) / _scales[i];
      if (!std::isfinite(term))
        throw core::NotFiniteError("the Taylor series of a solution is not finite: a singularity of the field");
      norm = std::max(norm, term);
    }
    log_step = std::min(log_step, (-_options.digits - std::log10(norm)) / k);
  }
  return std::pow(10.0, log_step);
}

void ManyFlows::advance(std::vector<std::vector<double>>& states, double time) {
  for (const std::vector<double>& state : states)
    core::require(state.size() == _dimension, "a state of another dimension");
  if (states.empty() || time == 0.0) return;
  std::size_t next = 0;
  std::size_t running = 0;
  std::array<std::size_t, width> place{};
  std::array<double, width> remaining{};
  std::array<long, width> steps{};
  std::vector<ad::Lanes> at(_dimension, ad::Lanes(0.0));
  const auto load = [&](std::size_t lane) {  // a lane without work repeats the last state, and nobody asks
    const bool works = next < states.size();
    place[lane] = works ? next++ : states.size();
    remaining[lane] = works ? time : 0.0;
    steps[lane] = 0;
    if (works) ++running;
    const std::vector<double>& state = works ? states[place[lane]] : states.back();
    for (std::size_t i = 0; i < _dimension; ++i) at[i].packed[lane] = state[i];
  };
  for (std::size_t lane = 0; lane < width; ++lane) load(lane);
  const std::vector<ad::Lanes> none;
  while (running > 0) {
    _series->expand(at, none);
    ad::Lanes step(0.0);
    for (std::size_t lane = 0; lane < width; ++lane)
      if (place[lane] < states.size()) {
        const double length = step_size(lane);
        step.packed[lane] =
            length >= std::abs(remaining[lane]) ? remaining[lane] : std::copysign(length, remaining[lane]);
      }
    for (std::size_t i = 0; i < _dimension; ++i) _series->sum(i, step, at[i]);
    for (std::size_t lane = 0; lane < width; ++lane) {
      if (place[lane] == states.size()) continue;
      remaining[lane] -= step.packed[lane];
      if (++steps[lane] > _options.most_steps)
        throw core::NumericalError("a Taylor integration was given up: its steps become ever shorter");
      if (remaining[lane] != 0.0) continue;
      for (std::size_t i = 0; i < _dimension; ++i) states[place[lane]][i] = at[i].packed[lane];
      --running;
      load(lane);
    }
  }
}

template class Flow<double>;
template class Flow<numerics::Extended>;

}  // namespace orbweaver::taylor
