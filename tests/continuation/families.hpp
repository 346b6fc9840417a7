#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::test {

inline std::shared_ptr<const systems::System> pendulum() {
  static const std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  return system;
}

/// The start of a family as the sweep hands it over: the equilibrium with its normal mode.
inline continuation::Start start_of(const PendulumMode& mode, int cutoff = 10) {
  continuation::Start start;
  start.base = loop::constant_loop(mode.point, mode.period(), cutoff);
  start.direction.modes = linear_loop(mode, 1.0, cutoff).modes;
  for (std::size_t i = 0; i < 4; ++i) start.direction.modes[i] = 0.0;
  start.isotropy = pendulum_isotropy(*pendulum());
  return start;
}

struct Trace {
  std::vector<continuation::Orbit> orbits;
  continuation::Ending ending;

  [[nodiscard]] const continuation::Orbit& last() const { return orbits.back(); }
};

inline Trace trace_of(std::shared_ptr<const systems::System> system, const continuation::Start& start,
                      const continuation::Options& options) {
  Trace out;
  out.ending = continuation::trace(std::move(system), start, options, [&](const continuation::Orbit& orbit) {
    out.orbits.push_back(orbit);
    return true;
  });
  return out;
}

inline Trace trace_of(const PendulumMode& mode, const continuation::Options& options) {
  return trace_of(pendulum(), start_of(mode), options);
}

/// The family from its equilibrium to T = 12 with adaptive steps, traced once a process; `mapped`: under the time maps
/// that fit it, as branches are by default.
inline const Trace& family_to_twelve(const PendulumMode& mode, bool mapped = true) {
  static std::map<std::pair<std::string, bool>, Trace> traced;
  const auto key = std::pair(mode.name, mapped);
  if (traced.count(key) == 0) {
    continuation::Options options;
    options.period_limit = 12.0;
    options.fit_time_map = mapped;
    traced[key] = trace_of(mode, options);
  }
  return traced[key];
}

/// The same with loops that run evenly in time.
inline const Trace& even_family_to_twelve(const PendulumMode& mode) { return family_to_twelve(mode, false); }

/// The orbit of a traced family with exactly this period.
inline corrector::Result orbit_at(const Trace& family, double period) {
  const continuation::Orbit* nearest = &family.orbits.front();
  for (const continuation::Orbit& orbit : family.orbits)
    if (std::abs(orbit.loop.period - period) < std::abs(nearest->loop.period - period)) nearest = &orbit;
  return continuation::orbit_at_period(*pendulum(), nearest->loop, pendulum_isotropy(*pendulum()), period, {});
}

}  // namespace orbweaver::test
