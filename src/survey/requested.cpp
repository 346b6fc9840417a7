#include "requested.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "executor.hpp"
#include "orbweaver/bifurcation/locate.hpp"

namespace orbweaver::survey {

namespace {

using Value = std::function<double(const loop::Loop&)>;

/// The orbit between the two where `value` is `wanted`.
std::optional<continuation::CurvePoint> orbit_with(const Value& value, double wanted, continuation::FamilyCurve& family,
                                                   const continuation::Orbit& from, const continuation::Orbit& to) {
  const auto along = [&](double position) {
    const auto point = family.at(position);
    return point ? value(point->loop) - wanted : std::numeric_limits<double>::quiet_NaN();
  };
  const auto located = bifurcation::locate_root(along, from.arclength, to.arclength, 1e-14 * (1.0 + to.arclength));
  return located ? family.at(located->position) : std::nullopt;
}

continuation::Orbit orbit_of(const systems::System& system, const corrector::Result& result, double arclength) {
  continuation::Orbit orbit;
  orbit.loop = result.loop;
  orbit.arclength = arclength;
  orbit.energy = continuation::energy_of(system, orbit.loop);
  orbit.action = continuation::action_of(system, orbit.loop);
  orbit.loss_rms = result.loss_rms;
  orbit.tail = loop::tail(orbit.loop);
  orbit.iterations = result.iterations;
  return orbit;
}

bool between(double value, double a, double b) { return (value - a) * (value - b) < 0.0; }

}  // namespace

std::vector<continuation::Orbit> requested_orbits(const scene::Scene& scene, const systems::System& system,
                                                  continuation::FamilyCurve& family, const continuation::Orbit& from,
                                                  const continuation::Orbit& to) {
  std::vector<continuation::Orbit> found;
  const continuation::Options options = branch_options(scene);
  for (const double period : scene.events.periods) {
    if (!between(period, from.loop.period, to.loop.period)) continue;
    const auto near = orbit_with([](const loop::Loop& loop) { return loop.period; }, period, family, from, to);
    if (!near) continue;
    const corrector::Result exact =
        continuation::orbit_at_period(system, near->loop, family.isotropy(), period, options);
    if (exact.converged()) found.push_back(orbit_of(system, exact, near->position));
  }
  for (const double energy : scene.events.energies) {
    if (!between(energy, from.energy, to.energy)) continue;
    const auto near = orbit_with([&](const loop::Loop& loop) { return continuation::energy_of(system, loop); }, energy,
                                 family, from, to);
    if (!near) continue;
    const corrector::Result settled =
        continuation::orbit_at_period(system, near->loop, family.isotropy(), near->loop.period, options);
    if (settled.converged()) found.push_back(orbit_of(system, settled, near->position));
  }
  std::sort(found.begin(), found.end(),
            [](const continuation::Orbit& a, const continuation::Orbit& b) { return a.arclength < b.arclength; });
  return found;
}

}  // namespace orbweaver::survey
