#include "orbweaver/certificate/integrate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

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

bool is_finite(const State& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

double norm(const State& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
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

/// A first step that is right to within the factor 5 by which the controller corrects a step.
double first_step(const State& state, const State& field, double time, double tolerance) {
  const double speed = norm(field);
  if (speed == 0.0) return time;
  const double guess = std::pow(tolerance, 1.0 / order) * (least_size + norm(state)) / speed;
  return std::copysign(std::min(guess, std::abs(time)), time);
}

}  // namespace

std::vector<double> integrate(const systems::System& system, std::vector<double> state, double time, double tolerance) {
  require_usable(system, state, time, tolerance);
  bool finite = true;
  const auto derivative = [&](const State& z, State& f, double) {
    system.field(1, z.data(), f.data());
    finite = finite && is_finite(f);
  };
  State field(state.size());
  derivative(state, field, 0.0);
  if (!finite || !is_finite(state)) fail(system, 0.0, time, "the state or the vector field there is not finite");

  auto stepper = odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>());
  double reached = 0.0;
  double step = first_step(state, field, time, tolerance);
  State next(state.size());
  for (int steps = 0; reached != time; ++steps) {
    core::interruption_point();
    if (steps == step_limit) fail(system, reached, time, "the limit of a million steps is reached");
    const bool last = std::abs(time - reached) <= std::abs(step);
    if (last) step = time - reached;
    const double tried = step;
    if (reached + tried == reached) fail(system, reached, time, "the step has become too small to advance");
    double after = reached;
    finite = true;
    const auto outcome = stepper.try_step(derivative, state, after, next, step);
    if (!finite || !is_finite(next)) {
      // A trial step may leave the domain where the orbit does not: only a state that no small step leaves is at fault.
      step = shortened * tried;
      if (reached + step == reached) fail(system, reached, time, "the state or the vector field there is not finite");
      continue;
    }
    if (outcome == odeint::fail) continue;
    std::swap(state, next);
    reached = last ? time : after;
  }
  return state;
}

}  // namespace orbweaver::certificate
