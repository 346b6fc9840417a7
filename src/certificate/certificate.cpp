#include "orbweaver/certificate/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/taylor/flow.hpp"

namespace orbweaver::certificate {

namespace {

using State = std::vector<double>;

double distance(const State& a, const State& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// z(t_0), ..., z(t_segments); the last is the first after all windings, so that it is exactly as far as the angles
/// turned.
std::vector<State> states_at_segment_ends(const loop::Loop& loop, int segments) {
  std::vector<State> states;
  for (int m = 0; m < segments; ++m) states.push_back(loop::state_at(loop, loop.period * m / segments));
  State end = states.front();
  for (std::size_t i = 0; i < end.size(); ++i) end[i] += 2.0 * std::numbers::pi * loop.winding[i];
  states.push_back(std::move(end));
  return states;
}

/// Where `advance(state, time)` takes the states at the segments' beginnings.
template <class Advance>
std::vector<State> ends_of(const systems::System& system, const loop::Loop& loop, const std::vector<State>& states,
                           const Options& options, const Advance& advance) {
  std::vector<State> ends;
  for (int m = 0; m < options.segments; ++m) {
    try {
      ends.push_back(advance(states[static_cast<std::size_t>(m)], loop.period / options.segments));
    } catch (const core::NumericalError& error) {
      const double period = loop.period * system.scales().time;
      throw core::NumericalError(fmt::format("segment {} of {} of a loop with period {} (from t = {}): {}", m + 1,
                                             options.segments, period, period * m / options.segments, error.what()));
    }
  }
  return ends;
}

std::vector<State> runge_kutta_ends(const systems::System& system, const loop::Loop& loop,
                                    const std::vector<State>& states, const Options& options) {
  return ends_of(system, loop, states, options,
                 [&](const State& state, double time) { return integrate(system, state, time, options.tolerance); });
}

std::vector<State> taylor_ends(const systems::System& system, const loop::Loop& loop, const std::vector<State>& states,
                               const Options& options) {
  const auto* with_formulas = dynamic_cast<const systems::FormulaSystem*>(&system);
  core::require(with_formulas != nullptr, "Taylor series are of systems that give their formulas");
  const systems::Formulas formulas = with_formulas->formulas();
  taylor::Flow<double> flow(formulas, formulas.values, {});
  return ends_of(system, loop, states, options, [&](State state, double time) {
    flow.advance(state, time);
    return state;
  });
}

/// The largest distance between the segments' ends and `states`, from the state number `first` on.
double largest_gap(const std::vector<State>& ends, const std::vector<State>& states, std::size_t first) {
  double largest = 0.0;
  for (std::size_t m = 0; m < ends.size(); ++m) largest = std::max(largest, distance(ends[m], states[m + first]));
  return largest;
}

void require_certifiable(const systems::System& system, const loop::Loop& loop, const Options& options) {
  loop::validate(loop);
  core::require(loop.dimension == system.dimension(), "the loop and the system must have the same dimension");
  core::require(options.segments >= 1, "a certificate needs at least one segment");
}

double energy_drift_of(const systems::System& system, const std::vector<State>& states) {
  if (!system.structure().conservative()) return std::numeric_limits<double>::quiet_NaN();
  const double start = system.conserved(0, states.front());
  double largest = 0.0;
  for (const State& state : states) largest = std::max(largest, std::abs(system.conserved(0, state) - start));
  return largest;
}

double norm(const State& state) {
  double sum = 0.0;
  for (const double value : state) sum += value * value;
  return std::sqrt(sum);
}

double reach_of(const std::vector<State>& states) {
  double largest = 0.0;
  for (const State& state : states) largest = std::max(largest, norm(state));
  return largest;
}

double steepness_of(const systems::System& system, const std::vector<State>& states) {
  if (!system.structure().conservative()) return 0.0;
  double largest = 0.0;
  State gradient(states.front().size());
  for (const State& state : states) {
    system.conserved_gradient(0, state, gradient);
    largest = std::max(largest, norm(gradient));
  }
  return largest;
}

// NaN where the orbit is so unstable that the integration leaves the region where the system is defined.
double single_shot_of(const systems::System& system, const std::vector<State>& states, double period,
                      double tolerance) {
  try {
    return distance(integrate(system, states.front(), period, tolerance), states.back());
  } catch (const core::NumericalError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

Certificate certify(const systems::System& family, const loop::Loop& loop, const Options& options) {
  const core::LogStage stage(core::Stage::certificate);
  require_certifiable(family, loop, options);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const std::vector<State> states = states_at_segment_ends(loop, options.segments);
  Certificate certificate;
  certificate.closure = largest_gap(runge_kutta_ends(system, loop, states, options), states, 1);
  certificate.single_shot = single_shot_of(system, states, loop.period, options.tolerance);
  certificate.energy_drift = energy_drift_of(system, states);
  certificate.reach = reach_of(states);
  certificate.steepness = steepness_of(system, states);
  return certificate;
}

Closures closures(const systems::System& family, const loop::Loop& loop, const Options& options) {
  const core::LogStage stage(core::Stage::certificate);
  require_certifiable(family, loop, options);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const std::vector<State> states = states_at_segment_ends(loop, options.segments);
  const std::vector<State> by_runge_kutta = runge_kutta_ends(system, loop, states, options);
  const std::vector<State> by_taylor = taylor_ends(system, loop, states, options);
  return {largest_gap(by_runge_kutta, states, 1), largest_gap(by_taylor, states, 1),
          largest_gap(by_runge_kutta, by_taylor, 0)};
}

}  // namespace orbweaver::certificate
