#include "orbweaver/certificate/integrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::certificate {

namespace {

namespace odeint = boost::numeric::odeint;

constexpr int step_limit = 1'000'000;
/// Below the first one steps are rounding; above the second the method's order means nothing.
constexpr double least_tolerance = 1e-15;
constexpr double largest_tolerance = 0.1;
constexpr int order = 8;
constexpr int order_of_error = 7;
constexpr std::size_t slopes = 13;
/// The first step moves the state by tolerance^(1/order) of its size, taken as this at least.
constexpr double least_size = 0.01;
/// Of a step that left the field's domain.
constexpr double shortened = 0.1;

constexpr const char* not_finite = "the state or the vector field there is not finite";

/// States on their ways side by side, each with steps of its own: where one arrives does not depend on the others. A
/// stage of a step is one evaluation of the field at all of them. Behind each state, if it is asked for, its transition
/// matrix, row after row; component after component, as the field takes them.
class Integration {
 public:
  Integration(const systems::System& system, const std::vector<Journey>& journeys, double tolerance,
              bool with_transitions)
      : _system(system),
        _dimension(static_cast<std::size_t>(system.dimension())),
        _components(_dimension * (with_transitions ? 1 + _dimension : 1)),
        _tolerance(tolerance),
        _arrivals(journeys.size()),
        _values(journeys.size() * _components, 0.0) {
    core::require(tolerance >= least_tolerance && tolerance <= largest_tolerance,
                  "the tolerance of an integration must be in [1e-15, 0.1]");
    for (std::size_t j = 0; j < journeys.size(); ++j) begin(j, journeys[j], journeys.size());
  }

  std::vector<Arrival> run() {
    drop_ended();
    while (!_ways.empty()) {
      core::interruption_point();
      const std::size_t size = _values.size();
      _slopes.resize(slopes * size);
      _at.resize(size);
      _error.resize(size);
      derivative(_values.data(), _slopes.data());
      for (std::size_t j = 0; j < _ways.size(); ++j) choose_step(j);
      times_step(_slopes.data());
      std::apply([this](const auto&... weights) { (stage(weights), ...); }, _stages);
      sum(odeint::rk78_coefficients_b<>(), _values.data(), _at.data());
      std::fill(_error.begin(), _error.end(), 0.0);
      sum(odeint::rk78_coefficients_db<>(), _error.data(), _error.data());
      bool has_ended = false;
      for (std::size_t j = 0; j < _ways.size(); ++j) {
        take(j);
        has_ended = has_ended || _ways[j].ended;
      }
      if (has_ended) drop_ended();
    }
    return std::move(_arrivals);
  }

 private:
  struct Way {
    std::size_t place = 0;  ///< among the journeys
    double time = 0.0;
    double allowed = 0.0;  ///< of an error, beside zero
    double reached = 0.0;
    double step = 0.0;  ///< the next
    int steps = 0;      ///< tried
    bool ended = false;
  };

  [[nodiscard]] bool with_transitions() const { return _components > _dimension; }
  [[nodiscard]] std::size_t entry(std::size_t i, std::size_t c) const { return _dimension + i * _dimension + c; }

  void begin(std::size_t j, const Journey& journey, std::size_t nodes) {
    core::require(journey.state.size() == _dimension,
                  "the state to integrate must have one number a coordinate of the system");
    core::require(std::isfinite(journey.time), "the time to integrate over must be finite");
    double square = 0.0;
    for (std::size_t i = 0; i < _dimension; ++i) {
      _values[i * nodes + j] = journey.state[i];
      square += journey.state[i] * journey.state[i];
      if (with_transitions()) _values[entry(i, i) * nodes + j] = 1.0;
    }
    // The entries of a transition matrix are about 1.
    const double size = with_transitions() || square == 0.0 ? 1.0 : std::min(1.0, std::sqrt(square));
    _ways.push_back({j, journey.time, _tolerance * size});
    _ways.back().ended = journey.time == 0.0;
  }

  void derivative(const double* z, double* f) {
    const std::size_t nodes = _ways.size();
    if (!with_transitions()) return _system.field(nodes, z, f);
    _jacobian.resize(nodes * _dimension * _dimension);
    _system.field_jacobian(nodes, z, f, _jacobian.data());
    std::fill(f + _dimension * nodes, f + _components * nodes, 0.0);
    for (std::size_t i = 0; i < _dimension; ++i)
      for (std::size_t l = 0; l < _dimension; ++l)
        for (std::size_t c = 0; c < _dimension; ++c)
          for (std::size_t j = 0; j < nodes; ++j)
            f[entry(i, c) * nodes + j] += _jacobian[(i * _dimension + l) * nodes + j] * z[entry(l, c) * nodes + j];
  }

  /// By how much the states change in their steps.
  void times_step(double* f) const {
    const std::size_t nodes = _ways.size();
    for (std::size_t i = 0; i < _components; ++i)
      for (std::size_t j = 0; j < nodes; ++j) f[i * nodes + j] *= _ways[j].step;
  }

  /// from + the weighted sum of the first slopes. Weights of 0 are no exception: what is not finite shows.
  template <class Weights>
  void sum(const Weights& weights, const double* from, double* to) const {
    const std::size_t size = _values.size();
    const double* const k = _slopes.data();
    for (std::size_t i = 0; i < size; ++i) {
      double value = from[i];
      for (std::size_t l = 0; l < Weights::static_size; ++l) value += weights[l] * k[l * size + i];
      to[i] = value;
    }
  }

  template <class Weights>
  void stage(const Weights& weights) {
    sum(weights, _values.data(), _at.data());
    double* const f = _slopes.data() + Weights::static_size * _values.size();
    derivative(_at.data(), f);
    times_step(f);
  }

  /// What has ended goes with what it has come to, and the others close up.
  void drop_ended() {
    const std::size_t nodes = _ways.size();
    std::vector<std::size_t> kept;
    for (std::size_t j = 0; j < nodes; ++j) {
      if (!_ways[j].ended) {
        kept.push_back(j);
        continue;
      }
      for (std::size_t i = with_transitions() ? _dimension : 0; i < _components; ++i)
        _arrivals[_ways[j].place].values.push_back(_values[i * nodes + j]);
    }
    for (std::size_t i = 0; i < _components; ++i)
      for (std::size_t j = 0; j < kept.size(); ++j) _values[i * kept.size() + j] = _values[i * nodes + kept[j]];
    for (std::size_t j = 0; j < kept.size(); ++j) _ways[j] = _ways[kept[j]];
    _values.resize(kept.size() * _components);
    _ways.resize(kept.size());
  }

  void fail(Way& way, const char* reason) {
    const double unit = _system.scales().time;
    _arrivals[way.place].failure = fmt::format("integration of '{}' over a time of {} stopped at t = {}: {}",
                                               _system.info().name, way.time * unit, way.reached * unit, reason);
    way.ended = true;
  }

  /// A first step that is right to within the factor 5 by which the controller corrects a step. NaN where the state or
  /// the field is not finite.
  [[nodiscard]] double first_step(std::size_t j) const {
    double speed = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < _dimension; ++i) {
      const std::size_t at = i * _ways.size() + j;
      speed += _slopes[at] * _slopes[at];
      size += _values[at] * _values[at];
    }
    if (!std::isfinite(speed + size)) return std::numeric_limits<double>::quiet_NaN();
    if (speed == 0.0) return std::numeric_limits<double>::infinity();
    return std::pow(_tolerance, 1.0 / order) * (least_size + std::sqrt(size)) / std::sqrt(speed);
  }

  void choose_step(std::size_t j) {
    Way& way = _ways[j];
    if (way.steps == 0) way.step = std::copysign(first_step(j), way.time);
    const double rest = way.time - way.reached;
    if (std::abs(rest) <= std::abs(way.step)) way.step = rest;
    if (std::isnan(way.step)) return fail(way, not_finite);
    if (way.steps++ == step_limit) return fail(way, "the limit of a million steps is reached");
    if (way.reached + way.step == way.reached) return fail(way, "the step has become too small to advance");
  }

  /// The step, if it is good enough, and the length of the next one.
  void take(std::size_t j) {
    Way& way = _ways[j];
    if (way.ended) return;
    const std::size_t nodes = _ways.size();
    double error = 0.0;
    double sum = 0.0;
    for (std::size_t at = j; at < _values.size(); at += nodes) {
      const double size = std::abs(_values[at]) + std::abs(_slopes[at]);
      error = std::max(error, std::abs(_error[at]) / (way.allowed + _tolerance * size));
      sum += 0.0 * _at[at];  // 0 for finite numbers only
    }
    if (sum != 0.0) {
      // A trial step may leave the domain where the orbit does not: only a state that no small step leaves is at fault.
      way.step *= shortened;
      if (way.reached + way.step == way.reached) fail(way, not_finite);
      return;
    }
    const odeint::default_step_adjuster<double, double> adjuster;
    if (error > 1.0) {
      way.step = adjuster.decrease_step(way.step, error, order_of_error);
      return;
    }
    for (std::size_t at = j; at < _values.size(); at += nodes) _values[at] = _at[at];
    way.reached = way.step == way.time - way.reached ? way.time : way.reached + way.step;
    way.step = adjuster.increase_step(way.step, error, order);
    way.ended = way.reached == way.time;
  }

  const systems::System& _system;
  std::size_t _dimension;
  std::size_t _components;
  double _tolerance;
  std::vector<Arrival> _arrivals;
  std::vector<Way> _ways;
  std::vector<double> _values;  // of the ways
  std::vector<double> _slopes;  // at each stage
  std::vector<double> _at;      // of the stage; then the end of the step
  std::vector<double> _error;
  std::vector<double> _jacobian;
  std::tuple<odeint::rk78_coefficients_a1<>, odeint::rk78_coefficients_a2<>, odeint::rk78_coefficients_a3<>,
             odeint::rk78_coefficients_a4<>, odeint::rk78_coefficients_a5<>, odeint::rk78_coefficients_a6<>,
             odeint::rk78_coefficients_a7<>, odeint::rk78_coefficients_a8<>, odeint::rk78_coefficients_a9<>,
             odeint::rk78_coefficients_a10<>, odeint::rk78_coefficients_a11<>, odeint::rk78_coefficients_a12<>>
      _stages;
};

std::vector<std::vector<double>> all_values(std::vector<Arrival> arrivals) {
  std::vector<std::vector<double>> values;
  for (Arrival& arrival : arrivals) {
    if (!arrival.failure.empty()) throw core::NumericalError(arrival.failure);
    values.push_back(std::move(arrival.values));
  }
  return values;
}

std::vector<Journey> from_all(const std::vector<std::vector<double>>& states, double time) {
  std::vector<Journey> journeys;
  for (const std::vector<double>& state : states) journeys.push_back({state, time});
  return journeys;
}

}  // namespace

std::vector<double> integrate(const systems::System& system, std::vector<double> state, double time, double tolerance) {
  return integrate_together(system, {std::move(state)}, time, tolerance).front();
}

std::vector<Arrival> integrate(const systems::System& system, const std::vector<Journey>& journeys, double tolerance) {
  return Integration(system, journeys, tolerance, false).run();
}

std::vector<std::vector<double>> integrate_together(const systems::System& system,
                                                    const std::vector<std::vector<double>>& states, double time,
                                                    double tolerance) {
  return all_values(integrate(system, from_all(states, time), tolerance));
}

std::vector<std::vector<double>> transitions(const systems::System& system,
                                             const std::vector<std::vector<double>>& states, double time,
                                             double tolerance) {
  return all_values(Integration(system, from_all(states, time), tolerance, true).run());
}

}  // namespace orbweaver::certificate
