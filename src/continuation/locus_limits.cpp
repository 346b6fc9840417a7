#include "locus_limits.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "point_problem.hpp"

namespace orbweaver::continuation {

namespace {

/// What a broken part may have turned by, in parts of its size, where the symmetry is gained between two points: one
/// that turns round without vanishing is all turned.
constexpr double turned = 0.5;
/// Points from which the place of an arrival is extrapolated, and how far apart the squares of their broken parts are.
constexpr std::size_t most_points = 3;
constexpr double apart = 1.3;

/// The oscillation of a loop along that of `from`, in parts of it: below zero where the way from one to the other leads
/// across an equilibrium.
double oscillation_along(const loop::Loop& from, const loop::Loop& there) {
  const std::size_t both = std::min(from.modes.size(), there.modes.size());
  double product = 0.0;
  double square = 0.0;
  for (auto n = static_cast<std::size_t>(from.dimension); n < both; ++n) {
    product += from.modes[n] * there.modes[n];
    square += from.modes[n] * from.modes[n];
  }
  return product / square;
}

/// T and parameters where the broken part vanishes: they are functions of its square.
loop::Loop at_arrival(const LocusArrival& arrival, const std::vector<LocusPoint>& before, const loop::Loop& from) {
  std::vector<double> squares{1.0};
  std::vector<const loop::Loop*> loops{&from};
  for (auto point = before.rbegin(); point != before.rend() && loops.size() < most_points; ++point) {
    const double part = arrival.broken(point->loop)[0];
    if (part * part < apart * squares.back()) continue;
    squares.push_back(part * part);
    loops.push_back(&point->loop);
  }
  const std::vector<double> weights = numerics::lagrange_weights(squares, 0.0).value;
  loop::Loop there = from;
  there.period = 0.0;
  std::fill(there.parameters.begin(), there.parameters.end(), 0.0);
  for (std::size_t n = 0; n < loops.size(); ++n) {
    there.period += weights[n] * loops[n]->period;
    for (std::size_t p = 0; p < there.parameters.size(); ++p)
      there.parameters[p] += weights[n] * loops[n]->parameters[p];
  }
  return there;
}

}  // namespace

std::vector<LocusLimit> limits_of(const systems::System& system, const LocusOptions& options, const LocusTest& test) {
  const Options& o = options.branch;
  const systems::Scales& scales = system.scales();
  const std::vector<std::string>& free = system.family_scalars().free;
  std::vector<LocusLimit> limits;
  const auto add = [&](EndReason reason, const std::string& name, double value, double unit, auto of) {
    if (!std::isfinite(value)) return;
    limits.push_back({{reason, fmt::format("{} = {:.9g}", name, value * unit)},
                      [of, value](const loop::Loop& loop) { return of(loop) - value; }});
  };
  const auto add_parameter = [&](std::size_t n, double value) {
    add(EndReason::parameter_limit, free[n], value, scales.parameter(n),
        [n](const loop::Loop& loop) { return loop.parameters[n]; });
  };
  add(EndReason::period_limit, "T", o.period_limit, scales.time, [](const loop::Loop& loop) { return loop.period; });
  for (const double value : {options.from, options.to}) add_parameter(free.size() - 1, value);
  if (free.size() > 1)
    for (const double value : {o.parameter_from, o.parameter_to}) add_parameter(0, value);
  for (const double value : {o.energy_from, o.energy_to})
    add(EndReason::energy_limit, "E", value, scales.energy(),
        [&system](const loop::Loop& loop) { return energy_of(system, loop); });
  for (const LocusBoundary& boundary : test.boundaries) limits.push_back({boundary.ending, boundary.inside});
  return limits;
}

std::optional<std::pair<Ending, double>> arrival_between(const systems::System& system, const LocusTest& test,
                                                         const std::vector<LocusPoint>& before, const loop::Loop& from,
                                                         const loop::Loop& to) {
  const double oscillation = oscillation_along(from, to);
  if (!winds(from.winding) && oscillation < 0.0) {
    const LocusArrival vanishing{"", [&](const loop::Loop& there) {
                                   return std::array<double, 2>{oscillation_along(from, there), 0.0};
                                 }};
    return {{{EndReason::fixed_point, fmt::format("near {}", place_text(system, at_arrival(vanishing, before, from)))},
             1.0 / (1.0 - oscillation)}};
  }
  if (!test.arrivals) return std::nullopt;
  for (const LocusArrival& arrival : test.arrivals(from, to)) {
    const auto [part, size] = arrival.broken(to);
    if (size * size - part * part > turned * turned * size * size) continue;
    const std::string where = place_text(system, at_arrival(arrival, before, from));
    return {{{EndReason::more_symmetry, fmt::format("{}, near {}", arrival.symmetry, where)},
             1.0 / (1.0 - std::min(part, 0.0))}};
  }
  return std::nullopt;
}

std::string place_text(const systems::System& system, const loop::Loop& loop) {
  const systems::Scales& scales = system.scales();
  std::string text = fmt::format("T = {:.9g}", loop.period * scales.time);
  for (std::size_t n = 0; n < loop.parameters.size(); ++n)
    text += fmt::format(", {} = {:.9g}", system.family_scalars().free[n], loop.parameters[n] * scales.parameter(n));
  return text;
}

}  // namespace orbweaver::continuation
