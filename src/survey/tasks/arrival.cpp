#include "arrival.hpp"

#include <cmath>

#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::survey {

namespace {

struct Sample {
  double part = 0.0;  // of what breaks the symmetry, relative to the first orbit's
  double period = 0.0;
  double energy = 0.0;
};

/// The value at part = 0 of the polynomial through the samples.
double at_zero(const std::vector<Sample>& samples, double Sample::*value) {
  std::vector<double> parts;
  for (const Sample& sample : samples) parts.push_back(sample.part);
  const std::vector<double> weights = numerics::lagrange_weights(parts, 0.0).value;
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) sum += weights[i] * samples[i].*value;
  return sum;
}

/// A smaller broken part is an orbit of the more symmetric family, onto which the corrector has slipped.
constexpr double slipped = 1e-6;

std::optional<ArrivalRecord> arrival_by(const systems::System& system, continuation::FamilyCurve& family,
                                        const bifurcation::SymmetryWatch& watch, const bifurcation::Gained& gained,
                                        const continuation::Orbit& from, const continuation::Orbit& to) {
  std::vector<Sample> samples;
  const auto add = [&](const loop::Loop& loop) {
    if (watch.relative_size(gained, from.loop, loop) < slipped) return;
    samples.push_back({watch.signed_part(gained, from.loop, loop), loop.period, continuation::energy_of(system, loop)});
  };
  // Orbits before the meeting point and, if the branch went on along the images, one beyond. At the point itself the
  // two families cannot be told apart, so that nothing is solved for there. Backwards from `from`, as long as the part
  // grows: a polynomial in it needs values well apart.
  const std::vector<continuation::FamilyCurve::Known>& known = family.known();
  for (auto orbit = known.rbegin(); orbit != known.rend() && samples.size() < 3; ++orbit) {
    if (orbit->position > from.arclength) continue;
    const std::size_t before = samples.size();
    add(orbit->loop);
    if (samples.size() == before) continue;
    if (before > 0 && samples.back().part < 1.2 * samples[before - 1].part) {
      samples.pop_back();
      break;
    }
  }
  add(to.loop);
  const double part = watch.signed_part(gained, from.loop, to.loop);
  const double there = from.arclength + 0.7 / (1.0 - std::min(part, 0.0)) * (to.arclength - from.arclength);
  loop::Loop near = from.loop;
  if (const auto point = family.at(there)) {
    const double size = watch.relative_size(gained, from.loop, point->loop);
    // A part that turns instead of vanishing is no arrival.
    if (size > 2.0 * std::abs(watch.signed_part(gained, from.loop, point->loop)) + 0.05) return std::nullopt;
    add(point->loop);
    if (size > 1e-2) near = point->loop;
  }
  ArrivalRecord record;
  record.period = at_zero(samples, &Sample::period);
  record.energy = at_zero(samples, &Sample::energy);
  record.near = sketch_of(near);
  return record;
}

}  // namespace

loop::Loop sketch_of(const loop::Loop& loop, int cutoff) {
  const loop::Loop even = loop.time_map.is_identity() ? loop : loop::with_time_map(loop, {}, loop.cutoff);
  return loop::with_cutoff(even, cutoff);
}

std::optional<ArrivalRecord> arrival_between(const systems::System& system, continuation::FamilyCurve& family,
                                             const bifurcation::SymmetryWatch& watch, const continuation::Orbit& from,
                                             const bifurcation::SymmetryWatch::Seen& from_seen,
                                             const continuation::Orbit& to,
                                             const bifurcation::SymmetryWatch::Seen& to_seen) {
  for (const bifurcation::Gained& gained : watch.all_passed(from_seen, to_seen))
    if (auto record = arrival_by(system, family, watch, gained, from, to)) return record;
  return std::nullopt;
}

}  // namespace orbweaver::survey
