#include "requested.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::survey {

namespace {

/// Width of the bracket in arclength, relative to 1 + the arclength: rounding of a position.
constexpr double position_width = 1e-14;

using Value = std::function<double(const loop::Loop&)>;

/// The orbit between the two where `value` is `wanted`.
std::optional<continuation::CurvePoint> orbit_with(const Value& value, double wanted, continuation::FamilyCurve& family,
                                                   const continuation::Orbit& from, const continuation::Orbit& to) {
  const auto along = [&](double position) {
    const auto point = family.at(position);
    return point ? value(point->loop) - wanted : std::numeric_limits<double>::quiet_NaN();
  };
  const auto located =
      numerics::locate_root(along, from.arclength, to.arclength, position_width * (1.0 + to.arclength));
  return located ? family.at(located->position) : std::nullopt;
}

continuation::Orbit orbit_of(const systems::System& system, const loop::Loop& loop, double arclength) {
  continuation::Orbit orbit;
  orbit.loop = loop;
  orbit.arclength = arclength;
  orbit.energy = continuation::energy_of(system, loop);
  orbit.action = continuation::action_of(system, loop);
  orbit.loss_rms = std::sqrt(loss::Linearization(system, loop, loss::Linearization::Order::residual).loss());
  orbit.tail = loop::tail(loop);
  return orbit;
}

bool between(double value, double a, double b) { return (value - a) * (value - b) < 0.0; }

}  // namespace

std::vector<continuation::Orbit> requested_orbits(const scene::Scene& scene, const systems::System& system,
                                                  continuation::FamilyCurve& family, const continuation::Orbit& from,
                                                  const continuation::Orbit& to, std::vector<std::string>& remarks) {
  std::vector<continuation::Orbit> found;
  const systems::Scales& units = system.scales();
  const auto missing = [&](const char* what, double value) {
    remarks.push_back(fmt::format("the orbit of {} {:.12g} between arclength {:.6g} and {:.6g} could not be converged",
                                  what, value, family.arclength_at(from.arclength), family.arclength_at(to.arclength)));
  };
  for (const double period : scene.events.periods) {
    if (!between(period, from.loop.period, to.loop.period)) continue;
    const auto near = orbit_with([](const loop::Loop& loop) { return loop.period; }, period, family, from, to);
    if (near) {
      const corrector::Result exact =
          continuation::orbit_at_period(system, near->loop, family.isotropy(), period, family.options());
      if (exact.converged()) {
        found.push_back(orbit_of(system, exact.loop, near->position));
        continue;
      }
    }
    missing("period", period * units.time);
  }
  for (const double energy : scene.events.energies) {
    if (!between(energy, from.energy, to.energy)) continue;
    const auto there = orbit_with([&](const loop::Loop& loop) { return continuation::energy_of(system, loop); }, energy,
                                  family, from, to);
    if (there)
      found.push_back(orbit_of(system, there->loop, there->position));
    else
      missing("energy", energy * units.energy());
  }
  std::sort(found.begin(), found.end(),
            [](const continuation::Orbit& a, const continuation::Orbit& b) { return a.arclength < b.arclength; });
  return found;
}

}  // namespace orbweaver::survey
