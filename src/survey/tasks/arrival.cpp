#include "arrival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "crossing_outcome.hpp"
#include "orbit_row.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/subharmonic_crossing.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::survey {

namespace {

struct Sample {
  double part = 0.0;  // of what breaks the symmetry, relative to the first orbit's
  double period = 0.0;
  double level = 0.0;
};

/// A place of the branch, and the signed part there.
struct Place {
  double position = 0.0;
  double part = 0.0;
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
/// Orbits before the meeting point that the extrapolation takes, at most (with one on the way and one beyond, a
/// quartic), and how far apart their parts must be: nearer ones multiply each other's errors. Not measured.
constexpr std::size_t orbits_before = 3;
constexpr double apart = 1.2;
/// Where on the way to the meeting point, by linear interpolation of the part, one more orbit is sought. Nearer to it
/// the corrector slips onto the more symmetric family. Not measured.
constexpr double on_the_way = 0.7;
/// With one more orbit the meeting's period and energy change by so much, relatively, or another is sought on what is
/// left of the way, a few times: a tenth of the window in which crossings are compared.
constexpr double settled = 1e-4;
constexpr int most_on_the_way = 6;
/// Where the corrector has slipped or failed, so much of that way is left to look on. Not measured.
constexpr double nearer = 0.5;
/// Places at which slopes tell folds, and functions their zeros, on the way to the meeting: each leaves so much less of
/// the way before it, and there are no more where so little of the part is left.
constexpr double of_what_is_left = 0.75;
constexpr double least_before = 1e-4;
/// The seventh lies there where the part falls evenly. Others lie where the corrector slips. Not measured.
constexpr int most_places_before = 12;
/// The part is proportional to its signed part where it vanishes: its size may be so many times that, and so much more.
/// A part that turns instead of vanishing keeps a size of about 1.
constexpr double proportional = 2.0;
constexpr double still_vanishing = 0.05;
/// What of the part is not proportional falls from place to place by half at least, or it turns: the part of a fast
/// oscillation may change its sign while the rest of the orbit breaks the symmetry as before (mu = 0.001, T = 82.01).
constexpr double falling = 0.5;
/// How much further from proportional than the least a part may be that vanishes where that does, and the rounding of
/// both. Near three times around an orbit other turns differed by 0.1 to 0.5, those of the orbit by 1e-6.
constexpr double as_proportional = 10.0;
constexpr double proportion_rounding = 1e-6;
/// How far an orbit may be from the crossing beneath it, in parts of what of it does not repeat: within 45 degrees of
/// the directions in which orbits leave there. Not measured.
constexpr double beside = 1.41;
/// A smaller broken part does not say in which direction the branch came.
constexpr double telling = 1e-2;

/// Of a part of the given size what is not proportional to that at the first orbit.
double not_proportional(double part, double size) { return std::sqrt(std::max(0.0, size * size - part * part)); }

/// Where the square of the part vanishes, which falls evenly with the way where the next orbit has slipped: the way to
/// that is measured along the more symmetric family.
double vanishes_at(const Place& one, const Place& other) {
  const double from = one.part * one.part;
  const double to = other.part * other.part;
  return other.position + to / (from - to) * (other.position - one.position);
}

/// Where the part itself does, falling evenly.
double falls_to_zero_at(const Place& one, const Place& other) {
  return other.position + other.part / (one.part - other.part) * (other.position - one.position);
}

int multiplicity_of(const bifurcation::SymmetryGain& gain) {
  return gain.name == "1" && !gain.reversing ? gain.shift_denominator : 1;
}

/// From `near` to where the broken part vanishes, in proportion to the way on which it falls from that of `from`; where
/// `near` is `from` itself, to that of `to`.
double distance_ahead(const bifurcation::SymmetryWatch& watch, const bifurcation::SymmetryGain& gain,
                      const loop::Loop& from, const loop::Loop& near, const loop::Loop& to) {
  const double part = watch.signed_part(gain, from, near);
  if (part < on_the_way) return std::abs(part) / (1.0 - part) * loop::mean_distance(from, near);
  return loop::mean_distance(from, to) / (1.0 - std::min(watch.signed_part(gain, from, to), 0.0));
}

std::optional<Arrival> arrival_by(const systems::System& system, continuation::FamilyCurve& family,
                                  const bifurcation::SymmetryWatch& watch, const bifurcation::SymmetryGain& gain,
                                  const continuation::Orbit& from, const continuation::Orbit& to) {
  std::vector<Sample> samples;
  const auto add = [&](const loop::Loop& loop) {
    if (watch.relative_size(gain, from.loop, loop) < slipped) return;
    samples.push_back({watch.signed_part(gain, from.loop, loop), loop.period, continuation::level_of(system, loop)});
  };
  // Orbits before the meeting point and, if the branch went on along the images, one beyond. At the point itself the
  // two families cannot be told apart, so that nothing is solved for there. Backwards from `from`, as long as the part
  // grows: a polynomial in it needs values well apart.
  const std::vector<continuation::FamilyCurve::Known>& known = family.known();
  for (auto orbit = known.rbegin(); orbit != known.rend() && samples.size() < orbits_before; ++orbit) {
    if (orbit->position > from.arclength) continue;
    const std::size_t before = samples.size();
    add(orbit->loop);
    if (samples.size() == before) continue;
    if (before > 0 && samples.back().part < apart * samples[before - 1].part) {
      samples.pop_back();
      break;
    }
  }
  add(to.loop);
  loop::Loop near = from.loop;
  Place before{from.arclength, 1.0};
  Place beyond{to.arclength, std::min(watch.signed_part(gain, from.loop, to.loop), 0.0)};
  double off_before = std::numeric_limits<double>::infinity();
  double slipped_at = std::numeric_limits<double>::quiet_NaN();
  for (int n = 0; n < most_on_the_way; ++n) {
    const double there =
        before.position + on_the_way * before.part / (before.part - beyond.part) * (beyond.position - before.position);
    const auto point = family.at(there);
    const double size = point ? watch.relative_size(gain, from.loop, point->loop) : 0.0;
    if (size < slipped) {  // so has `to`, or none converges there; the meeting point may lie nearer
      slipped_at = there;
      beyond = {before.position + nearer * (there - before.position), 0.0};
      continue;
    }
    const double part = watch.signed_part(gain, from.loop, point->loop);
    const double off = not_proportional(part, size);
    if (off > std::max(still_vanishing, falling * off_before)) return std::nullopt;
    off_before = off;
    if (size > proportional * std::abs(part) + still_vanishing) {
      if (n == 0) return std::nullopt;  // it turns instead of vanishing: no arrival
      break;
    }
    const std::size_t known_before = samples.size();
    const double period = at_zero(samples, &Sample::period);
    const double level = at_zero(samples, &Sample::level);
    add(point->loop);
    if (size > telling && part > 0.0) near = point->loop;  // beyond, other families may leave than the one that came
    if (samples.size() == known_before || size < telling ||
        (off <= still_vanishing && std::abs(at_zero(samples, &Sample::period) - period) <= settled * period &&
         !(std::abs(at_zero(samples, &Sample::level) - level) > settled * (1.0 + std::abs(level)))))
      break;
    const Place here{there, part};
    // The place supposed where the corrector has slipped may be too near.
    if (part > 0.0 && part < before.part && beyond.part == 0.0 && !std::isnan(slipped_at))
      beyond.position = std::clamp(vanishes_at(before, here), beyond.position, slipped_at);
    (part > 0.0 ? before : beyond) = here;
  }
  Arrival arrival;
  arrival.gain = gain;
  arrival.near = near;
  arrival.position = before.position + before.part / (before.part - beyond.part) * (beyond.position - before.position);
  ArrivalRecord& record = arrival.record;
  record.period = at_zero(samples, &Sample::period);
  record.level = at_zero(samples, &Sample::level);
  record.near = sketch_of(near);
  record.multiplicity = multiplicity_of(gain);
  record.ahead = distance_ahead(watch, gain, from.loop, near, to.loop);
  return arrival;
}

/// Of several gains, those whose parts vanish on the way: there they are proportional to that of `from`. Beside an
/// orbit of a higher symmetry the sign of a part turns for those too that come near to it. What a gain breaks and its
/// powers do not (1@1/4: the harmonics 2, 6, 10 ... of an orbit four times around) is of second order, and may be
/// larger.
std::vector<bifurcation::SymmetryGain> vanishing(std::vector<bifurcation::SymmetryGain> gains,
                                                 continuation::FamilyCurve& family,
                                                 const bifurcation::SymmetryWatch& watch,
                                                 const continuation::Orbit& from, const continuation::Orbit& to) {
  if (gains.size() < 2) return gains;
  const double beyond = std::min(watch.signed_part(gains.front(), from.loop, to.loop), 0.0);
  const auto point = family.at(from.arclength + on_the_way / (1.0 - beyond) * (to.arclength - from.arclength));
  if (!point) return gains;
  std::vector<double> off;
  for (const bifurcation::SymmetryGain& gain : gains) {
    const double part = watch.signed_part(gain, from.loop, point->loop);
    const double size = watch.relative_size(gain, from.loop, point->loop);
    off.push_back(not_proportional(part, size));
  }
  const double most = as_proportional * *std::min_element(off.begin(), off.end()) + proportion_rounding;
  const auto proportional_too = [&](std::size_t n) {
    if (off[n] <= most) return true;
    for (std::size_t power = 0; power < gains.size(); ++power)
      if (off[n] <= still_vanishing && off[power] <= most && watch.generates(gains[n], gains[power])) return true;
    return false;
  };
  std::vector<bifurcation::SymmetryGain> kept;
  for (std::size_t n = 0; n < gains.size(); ++n)
    if (proportional_too(n)) kept.push_back(gains[n]);
  return kept;
}

/// From the orbit at `from` on. False where the part turns on the way: orbits beyond are another family's, of less
/// symmetry, beside which the one that is met branches off (a cascade of period doublings within 3e-7 of a parameter:
/// what goes four times around the first orbit comes near to that, and meets the second).
bool add_places(Arrival& arrival, continuation::FamilyCurve& family, const bifurcation::SymmetryWatch& watch,
                double from) {
  auto last = family.at(from, true);
  if (!last || last->tangent.empty()) return true;
  std::vector<continuation::CurvePoint>& places = arrival.places;
  places.push_back(*std::move(last));
  Place before{from, 1.0};
  double beyond = family.known().back().position;
  double meeting = std::min(arrival.position, beyond);
  bool is_all_the_way = true;
  for (int n = 0; n < most_places_before && before.part > least_before; ++n) {
    const double place = before.position + of_what_is_left * (meeting - before.position);
    auto point = family.at(place, true);
    const auto part_from = [&](const continuation::CurvePoint& one) {
      return point && !point->tangent.empty() ? watch.signed_part(arrival.gain, one.loop, point->loop) : 0.0;
    };
    const double part = part_from(places.front());
    const continuation::CurvePoint& first = places[places.size() > 1 ? 1 : 0];
    const bool turns =
        part > slipped && watch.relative_size(arrival.gain, first.loop, point->loop) > beside * part_from(first);
    if (turns) is_all_the_way = false;
    // Beyond the meeting, or the corrector has slipped onto the family that is met. No orbit says nothing of where.
    if (turns || !(part > slipped)) {
      meeting = place;
      if (point) beyond = place;
      continue;
    }
    const Place here{place, part};
    if (part < before.part) meeting = std::min(falls_to_zero_at(before, here), beyond);
    before = here;
    places.push_back(*std::move(point));
  }
  arrival.position = meeting;
  return is_all_the_way;
}

/// What harmonics may leave out of a sketch: far below the distances that directions are told by.
constexpr double of_sketches = 1e-8;

/// In the terms of the family that the crossing lies on, which has the orbit's symmetries: their fundamental map, and
/// of its sectors in which families close after so many periods the one that the multipliers are nearest to.
void tell_by_symmetries(const systems::System& system, const loop::Isotropy& isotropy, int multiplicity,
                        bifurcation::CrossingFound& found) {
  const std::optional<spectrum::Stability> stability = stability_of(system, found.crossing.point.loop, isotropy);
  if (!stability) return;
  double least = std::numeric_limits<double>::infinity();
  for (const bifurcation::Sector& sector : bifurcation::sectors(stability->fundamental_order, multiplicity)) {
    if (sector.multiplicity(stability->fundamental_order) != multiplicity) continue;
    const double away = std::abs(bifurcation::index_deviation(system.structure(), *stability, sector).value);
    if (!(away < least)) continue;
    least = away;
    found.event.function.sector = sector;
  }
  found.crossing.stability = *stability;
}

}  // namespace

double not_repeated(const loop::Loop& loop, int times) {
  double square = 0.0;
  for (int k = 1; k <= loop.cutoff; ++k)
    for (int i = 0; k % times != 0 && i < loop.dimension; ++i)
      square += 0.5 * (loop.cosine(k, i) * loop.cosine(k, i) + loop.sine(k, i) * loop.sine(k, i));
  return std::sqrt(square);
}

loop::Loop sketch_of(const loop::Loop& loop, int cutoff) {
  // With as many harmonics as the loop has under its map, a close passage would spoil the few that are kept.
  const loop::Loop even = loop.time_map.is_identity() ? loop : loop::evenly_in_time(loop, of_sketches);
  return loop::with_cutoff(even, cutoff);
}

std::optional<Arrival> arrival_between(const systems::System& system, continuation::FamilyCurve& family,
                                       const bifurcation::SymmetryWatch& watch, const continuation::Orbit& from,
                                       const bifurcation::SymmetryWatch::SampledOrbit& from_sampled,
                                       const continuation::Orbit& to,
                                       const bifurcation::SymmetryWatch::SampledOrbit& to_sampled) {
  std::optional<Arrival> first;
  for (const bifurcation::SymmetryGain& gain :
       vanishing(watch.all_passed(from_sampled, to_sampled), family, watch, from, to)) {
    if (first && !watch.generates(first->gain, gain)) continue;
    std::optional<Arrival> arrival = arrival_by(system, family, watch, gain, from, to);
    if (!arrival) continue;
    const bool is_all_the_way = add_places(*arrival, family, watch, from.arclength);
    if (arrival->places.size() > 1) arrival->record.nearest = sketch_of(arrival->places.back().loop);
    if (is_all_the_way) return arrival;
    if (!first) first = std::move(arrival);
  }
  return first;
}

bool locate_beneath(const std::shared_ptr<const systems::System>& system, const continuation::Options& options,
                    const loop::Loop& last, ArrivalRecord& arrival) {
  if (arrival.multiplicity == 1) return false;
  const loop::Loop even = loop::evenly_in_time(last);
  const auto found = bifurcation::crossing_beneath(system, even, arrival.multiplicity, options);
  if (!found) return false;
  const loop::Loop& orbit = found->crossing.point.loop;
  const loop::Loop met = loop::repeated(loop::evenly_in_time(orbit), arrival.multiplicity);
  const double distance = loop::align(system->structure(), even, met).distance;
  if (distance > beside * not_repeated(even, arrival.multiplicity)) return false;
  arrival.period = met.period;
  arrival.level = continuation::level_of(*system, met);
  CrossingBeneath& beneath = arrival.beneath.emplace_back();
  bifurcation::CrossingFound there = *found;
  there.crossing.point.loop = loop::at_first_reversor(system->structure(), orbit, loop::symmetry_tolerance);
  const loop::Isotropy isotropy =
      loop::find_isotropy(system->structure(), there.crossing.point.loop, loop::symmetry_tolerance);
  tell_by_symmetries(*system, isotropy, arrival.multiplicity, there);
  describe(*system, there.event, there.crossing, isotropy, beneath.crossing);
  beneath.crossing.limited_by = order_limited;
  beneath.orbit = orbit;
  return true;
}

std::optional<ArrivalRecord> arrival_ahead(const std::shared_ptr<const systems::System>& system,
                                           const continuation::FamilyCurve& family,
                                           const bifurcation::SymmetryWatch& watch) {
  const loop::Loop& last = family.known().back().loop;
  for (const bifurcation::SymmetryGain& gain :
       watch.nearly_gained(bifurcation::SymmetryWatch::sampled(family.known().front().loop),
                           bifurcation::SymmetryWatch::sampled(last))) {
    ArrivalRecord record;
    record.multiplicity = multiplicity_of(gain);
    record.near = sketch_of(last);
    if (record.multiplicity >= bifurcation::least_weak_resonance &&
        locate_beneath(system, family.options(), last, record))
      return record;
  }
  return std::nullopt;
}

}  // namespace orbweaver::survey
