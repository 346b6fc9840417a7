#include "given_orbit_watch.hpp"

#include <algorithm>
#include <utility>

#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"

namespace orbweaver::survey {

namespace {

/// Where the comparison along a step does not decide, or finds the orbit this near to it (in parts of the step), it is
/// made along halves of the step, and of these once more. Not measured; most orbits are found along the whole.
constexpr int most_halvings = 2;
constexpr double near_step = 0.1;
/// How far a small orbit may be from that of the linear motion, in parts of its amplitude. Not measured: those of one
/// family differ in proportion to the amplitude, those of others are as far apart as they are large.
constexpr double like_direction = 0.5;

continuation::Orbit orbit_of(const systems::System& system, const loop::Loop& loop) {
  continuation::Orbit orbit;
  orbit.loop = loop;
  orbit.energy = continuation::energy_of(system, loop);
  orbit.action = continuation::action_of(system, loop);
  return orbit;
}

}  // namespace

GivenOrbitWatch::GivenOrbitWatch(std::shared_ptr<const systems::System> system, GivenOrbits given,
                                 continuation::Options options)
    : _system(std::move(system)),
      _options(std::move(options)),
      _given(std::move(given.all)),
      _small(std::move(given.small)) {
  for (const GivenOrbit& orbit : _given) _orbits.push_back(orbit_of(*_system, orbit.loop));
}

void GivenOrbitWatch::watch(const Lineage& own, const loop::Isotropy& isotropy, const continuation::Orbit& from,
                            const continuation::Orbit& to, std::vector<PassedStart>& passed) const {
  if (own.depth > 0) return;
  for (std::size_t n = 0; n < _given.size(); ++n) {
    const GivenOrbit& given = _given[n];
    if (given.family <= own.family) continue;
    const bool is_known = std::any_of(passed.begin(), passed.end(),
                                      [&](const PassedStart& other) { return other.family == given.family; });
    if (is_known || !lies_between(from, to, isotropy, _orbits[n], most_halvings)) continue;
    add({given.family, given.name, given.told}, given.loop, passed);
  }
}

void GivenOrbitWatch::arrive(const Lineage& own, const loop::Loop& last, std::vector<PassedStart>& passed) const {
  if (own.depth > 0) return;
  const double amplitude = loop::rms_amplitude(last);
  double nearest = like_direction * amplitude;
  const SmallFamily* found = nullptr;
  for (const SmallFamily& family : _small) {
    const double unit = loop::rms_amplitude(loop::moved(family.base, family.direction, 1.0));
    const loop::Loop small = loop::moved(family.base, family.direction, amplitude / unit);
    if (small.winding != last.winding) continue;
    const loop::Loop there = loop::aligned(small, loop::align(_system->structure(), small, last));
    const double distance = continuation::arclength_between(there, last);
    if (!(distance < nearest)) continue;
    nearest = distance;
    found = &family;
  }
  if (found && found->family > own.family) add({found->family, found->name, "small oscillations"}, found->base, passed);
}

void GivenOrbitWatch::add(PassedStart start, const loop::Loop& there, std::vector<PassedStart>& passed) const {
  const bool in_parameter = !_system->family_scalars().free.empty();
  const systems::Scales& units = _system->scales();
  start.period = there.period * units.time;
  start.level = continuation::level_of(*_system, there) * (in_parameter ? units.parameter(0) : units.energy());
  passed.push_back(std::move(start));
}

bool GivenOrbitWatch::lies_between(const continuation::Orbit& from, const continuation::Orbit& to,
                                   const loop::Isotropy& isotropy, const continuation::Orbit& orbit,
                                   int halvings) const {
  bifurcation::IdentityOptions options;
  options.cutoff_to = _options.cutoff_to;
  options.keeps_repetitions = true;  // given orbits go around once
  const bifurcation::Comparison found = bifurcation::same_family(*_system, from, to, isotropy, orbit, options);
  if (found.same || halvings == 0) return found.same;
  const double step = loop::mean_distance(from.loop, to.loop);
  if (found.decided && !(found.distance < near_step * step)) return false;
  continuation::FamilyCurve curve(_system, isotropy, _options);
  curve.add(0.0, from.loop);
  curve.add(1.0, to.loop);
  const std::optional<continuation::CurvePoint> half = curve.at(0.5);
  if (!half) return false;
  const continuation::Orbit middle = orbit_of(*_system, half->loop);
  return lies_between(from, middle, isotropy, orbit, halvings - 1) ||
         lies_between(middle, to, isotropy, orbit, halvings - 1);
}

}  // namespace orbweaver::survey
