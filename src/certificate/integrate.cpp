#include "orbweaver/certificate/integrate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <Eigen/Core>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::certificate {

namespace {

namespace odeint = boost::numeric::odeint;

using State = std::vector<double>;

constexpr int step_limit = 1'000'000;
/// Below the first one steps are rounding; above the second the method's order means nothing.
constexpr double least_tolerance = 1e-15;
constexpr double largest_tolerance = 0.1;
/// The first step moves the state by tolerance^(1/8), 8 being the method's order, of its size, taken as this at least.
constexpr double order = 8.0;
constexpr double least_size = 0.01;
/// Of a step that left the field's domain.
constexpr double shortened = 0.1;
/// States whose field is evaluated in one go.
constexpr std::size_t together = ad::Lanes::width;

/// 0 x is 0 for finite numbers only.
bool is_finite(const State& values) {
  return (0.0 * Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()))).sum() == 0.0;
}

[[noreturn]] void fail(const systems::System& system, double reached, double time, const char* reason) {
  throw core::NumericalError(fmt::format("integration of '{}' over a time of {} stopped at t = {}: {}",
                                         system.info().name, time * system.scales().time,
                                         reached * system.scales().time, reason));
}

void require_usable(const systems::System& system, const State& state, double time, double tolerance) {
  core::require(state.size() == static_cast<std::size_t>(system.dimension()),
                "the state to integrate must have one number a coordinate of the system");
  core::require(std::isfinite(time), "the time to integrate over must be finite");
  core::require(tolerance >= least_tolerance && tolerance <= largest_tolerance,
                "the tolerance of an integration must be in [1e-15, 0.1]");
}

/// States side by side, component after component, and behind them, if they are asked for, their transition matrices.
class Group {
 public:
  Group(const systems::System& system, std::span<const State> states, bool with_transitions)
      : _system(system),
        _nodes(states.size()),
        _dimension(static_cast<std::size_t>(system.dimension())),
        _with_transitions(with_transitions),
        _values(_nodes * _dimension * (with_transitions ? 1 + _dimension : 1), 0.0),
        _jacobian(with_transitions ? _nodes * _dimension * _dimension : 0) {
    for (std::size_t j = 0; j < _nodes; ++j)
      for (std::size_t i = 0; i < _dimension; ++i) {
        _values[i * _nodes + j] = states[j][i];
        if (with_transitions) _values[entry(i, i) + j] = 1.0;
      }
  }

  void advance(double time, double tolerance);

  [[nodiscard]] State state(std::size_t node) const {
    State state(_dimension);
    for (std::size_t i = 0; i < _dimension; ++i) state[i] = _values[i * _nodes + node];
    return state;
  }
  [[nodiscard]] State transition(std::size_t node) const {
    State matrix;
    for (std::size_t i = 0; i < _dimension; ++i)
      for (std::size_t c = 0; c < _dimension; ++c) matrix.push_back(_values[entry(i, c) + node]);
    return matrix;
  }

 private:
  [[nodiscard]] std::size_t entry(std::size_t i, std::size_t c) const {
    return (_dimension + i * _dimension + c) * _nodes;
  }

  void derivative(const State& z, State& f) {
    if (!_with_transitions) return _system.field(_nodes, z.data(), f.data());
    _system.field_jacobian(_nodes, z.data(), f.data(), _jacobian.data());
    std::fill(f.begin() + static_cast<std::ptrdiff_t>(entry(0, 0)), f.end(), 0.0);
    for (std::size_t i = 0; i < _dimension; ++i)
      for (std::size_t l = 0; l < _dimension; ++l)
        for (std::size_t c = 0; c < _dimension; ++c)
          for (std::size_t j = 0; j < _nodes; ++j)
            f[entry(i, c) + j] += _jacobian[(i * _dimension + l) * _nodes + j] * z[entry(l, c) + j];
  }

  /// The largest state's size, or 1 where that is larger, or beside transition matrices, whose entries are.
  [[nodiscard]] double size_of_small() const {
    double largest = 0.0;
    for (std::size_t j = 0; j < _nodes; ++j) {
      double square = 0.0;
      for (std::size_t i = 0; i < _dimension; ++i) square += _values[i * _nodes + j] * _values[i * _nodes + j];
      largest = std::max(largest, std::sqrt(square));
    }
    return _with_transitions || largest == 0.0 ? 1.0 : std::min(1.0, largest);
  }

  /// A first step that is right to within the factor 5 by which the controller corrects a step, at every state.
  [[nodiscard]] double first_step(const State& field, double time, double tolerance) const {
    double step = std::abs(time);
    for (std::size_t j = 0; j < _nodes; ++j) {
      double speed = 0.0;
      double size = 0.0;
      for (std::size_t i = 0; i < _dimension; ++i) {
        speed += field[i * _nodes + j] * field[i * _nodes + j];
        size += _values[i * _nodes + j] * _values[i * _nodes + j];
      }
      if (speed == 0.0) continue;
      step = std::min(step, std::pow(tolerance, 1.0 / order) * (least_size + std::sqrt(size)) / std::sqrt(speed));
    }
    return std::copysign(step, time);
  }

  const systems::System& _system;
  std::size_t _nodes;
  std::size_t _dimension;
  bool _with_transitions;
  State _values;
  State _jacobian;
};

void Group::advance(double time, double tolerance) {
  bool finite = true;
  const auto rate = [&](const State& z, State& f, double) {
    derivative(z, f);
    finite = finite && is_finite(f);
  };
  State field(_values.size());
  rate(_values, field, 0.0);
  if (!finite || !is_finite(_values)) fail(_system, 0.0, time, "the state or the vector field there is not finite");

  auto stepper =
      odeint::make_controlled(size_of_small() * tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>());
  double reached = 0.0;
  double step = first_step(field, time, tolerance);
  State next(_values.size());
  for (int steps = 0; reached != time; ++steps) {
    core::interruption_point();
    if (steps == step_limit) fail(_system, reached, time, "the limit of a million steps is reached");
    const bool last = std::abs(time - reached) <= std::abs(step);
    if (last) step = time - reached;
    const double tried = step;
    if (reached + tried == reached) fail(_system, reached, time, "the step has become too small to advance");
    double after = reached;
    finite = true;
    const auto outcome = stepper.try_step(rate, _values, after, next, step);
    if (!finite || !is_finite(next)) {
      // A trial step may leave the domain where the orbit does not: only a state that no small step leaves is at fault.
      step = shortened * tried;
      if (reached + step == reached) fail(_system, reached, time, "the state or the vector field there is not finite");
      continue;
    }
    if (outcome == odeint::fail) continue;
    std::swap(_values, next);
    reached = last ? time : after;
  }
}

/// The places of the states, those where the solution turns fastest for its size first: a group's steps are those of
/// its fastest state.
std::vector<std::size_t> by_speed(const systems::System& system, std::span<const State> states) {
  std::vector<double> speeds;
  State field(static_cast<std::size_t>(system.dimension()));
  for (const State& state : states) {
    system.field(1, state.data(), field.data());
    double speed = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < state.size(); ++i) {
      speed += field[i] * field[i];
      size += state[i] * state[i];
    }
    speeds.push_back(std::isfinite(speed) ? std::sqrt(speed) / (least_size + std::sqrt(size)) : 0.0);
  }
  std::vector<std::size_t> places(states.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return speeds[a] > speeds[b]; });
  return places;
}

/// `result(group, node)` at the end of the way from every state.
template <class Result>
std::vector<State> advance_all(const systems::System& system, std::span<const State> states, bool with_transitions,
                               double time, double tolerance, const Result& result) {
  for (const State& state : states) require_usable(system, state, time, tolerance);
  std::vector<State> results(states.size());
  const std::vector<std::size_t> places = by_speed(system, states);
  for (std::size_t first = 0; first < states.size(); first += together) {
    const std::size_t count = std::min(together, states.size() - first);
    std::vector<State> beside;
    for (std::size_t node = 0; node < count; ++node) beside.push_back(states[places[first + node]]);
    Group group(system, beside, with_transitions);
    group.advance(time, tolerance);
    for (std::size_t node = 0; node < count; ++node) results[places[first + node]] = result(group, node);
  }
  return results;
}

}  // namespace

std::vector<double> integrate(const systems::System& system, std::vector<double> state, double time, double tolerance) {
  require_usable(system, state, time, tolerance);
  Group group(system, {&state, 1}, false);
  group.advance(time, tolerance);
  return group.state(0);
}

std::vector<std::vector<double>> integrate_together(const systems::System& system,
                                                    const std::vector<std::vector<double>>& states, double time,
                                                    double tolerance) {
  return advance_all(system, states, false, time, tolerance,
                     [](const Group& group, std::size_t node) { return group.state(node); });
}

std::vector<std::vector<double>> transitions(const systems::System& system,
                                             const std::vector<std::vector<double>>& states, double time,
                                             double tolerance) {
  return advance_all(system, states, true, time, tolerance,
                     [](const Group& group, std::size_t node) { return group.transition(node); });
}

}  // namespace orbweaver::certificate
