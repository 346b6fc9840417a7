#include "locus_limits.hpp"

#include <cmath>

#include <fmt/format.h>

#include "orbweaver/continuation/orbit.hpp"

namespace orbweaver::continuation {

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

std::string place_text(const systems::System& system, const loop::Loop& loop) {
  const systems::Scales& scales = system.scales();
  std::string text = fmt::format("T = {:.9g}", loop.period * scales.time);
  for (std::size_t n = 0; n < loop.parameters.size(); ++n)
    text += fmt::format(", {} = {:.9g}", system.family_scalars().free[n], loop.parameters[n] * scales.parameter(n));
  return text;
}

}  // namespace orbweaver::continuation
