#include "arrival.hpp"

#include <cmath>

namespace orbweaver::survey {

namespace {

struct Sample {
  double part = 0.0;  // of what breaks the symmetry, relative to the first orbit's
  double period = 0.0;
  double energy = 0.0;
};

/// The value at part = 0 of the polynomial through the samples.
double at_zero(const std::vector<Sample>& samples, double Sample::*value) {
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double weight = 1.0;
    for (std::size_t l = 0; l < samples.size(); ++l)
      if (l != i) weight *= samples[l].part / (samples[l].part - samples[i].part);
    sum += weight * samples[i].*value;
  }
  return sum;
}

std::optional<ArrivalRecord> arrival_by(const systems::System& system, continuation::FamilyCurve& family,
                                        const bifurcation::SymmetryWatch& watch, const bifurcation::Gained& gained,
                                        const continuation::Orbit& from, const continuation::Orbit& to) {
  const auto sample = [&](const loop::Loop& loop) {
    return Sample{watch.signed_part(gained, from.loop, loop), loop.period, continuation::energy_of(system, loop)};
  };
  // At the meeting point itself the two families cannot be told apart: orbits on both sides, a fifth of the way off.
  std::vector<Sample> samples{sample(from.loop), sample(to.loop)};
  const double share = samples[0].part / (samples[0].part - samples[1].part);
  const double length = to.arclength - from.arclength;
  std::optional<continuation::CurvePoint> near;
  for (const double there : {0.8 * share, share + 0.2 * (1.0 - share)}) {
    auto point = family.at(from.arclength + there * length);
    if (!point) continue;
    const Sample found = sample(point->loop);
    // A part that turns instead of vanishing is no arrival.
    if (watch.relative_size(gained, from.loop, point->loop) > 2.0 * std::abs(found.part) + 0.05) return std::nullopt;
    samples.push_back(found);
    if (found.part > 0.0) near = std::move(point);
  }
  ArrivalRecord record;
  record.period = at_zero(samples, &Sample::period);
  record.energy = at_zero(samples, &Sample::energy);
  record.near = record_of(sketch_of(near ? near->loop : from.loop));
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
