#include "turn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace orbweaver::bifurcation {

namespace {

/// An extremum nearer than this share to an end of the interval is the end's: Brent's method stops there where the
/// function has none within.
constexpr double off_ends = 1e-3;

/// A slope that is zero by its signs alone, and at the zero more than this share of those at the ends, is rounding's.
constexpr double left_of_slope = 1e-2;
/// What a period or an energy rises to both ends from where it is least must be so many times what it scatters there:
/// within this share of the interval, over which it would rise by its square.
constexpr double clear_rise = 10.0;
constexpr double scattering[] = {-2e-6, -1e-6, 1e-6, 2e-6};
/// What turns differs by so many roundings between the place where its slope vanishes and that where it is extreme, at
/// most.
constexpr double as_extreme = 16.0;

/// Whether the quantity is largest (1) or least (-1) at a known orbit between two positions, seen from there: so turns
/// the fold that is looked for, and there may be another one beside it. 0 without such an orbit.
int sense_of_turn(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                  const Interval& within) {
  const auto first = family.at(within.from);
  const auto last = family.at(within.to);
  if (!first || !last) return 0;
  const double at_from = turning(system, event.kind, first->loop);
  const double at_to = turning(system, event.kind, last->loop);
  for (const continuation::FamilyCurve::Known& known : family.known()) {
    if (!(known.position > within.from && known.position < within.to)) continue;
    const double there = turning(system, event.kind, known.loop);
    if (there > std::max(at_from, at_to)) return 1;
    if (there < std::min(at_from, at_to)) return -1;
  }
  return 0;
}

/// Between known orbits, where the slope has one sign at both ends of the whole: the part on which it turns in that
/// sense.
std::optional<Interval> turning_part(EventFunction& slope_at, const continuation::FamilyCurve& family,
                                     const Interval& within, int sense) {
  std::vector<double> places{within.from};
  for (const continuation::FamilyCurve::Known& known : family.known())
    if (known.position > within.from && known.position < within.to) places.push_back(known.position);
  places.push_back(within.to);
  for (std::size_t n = 1; n < places.size(); ++n)
    if (sense * slope_at(places[n - 1]) > 0.0 && sense * slope_at(places[n]) < 0.0)
      return Interval{places[n - 1], places[n]};
  return std::nullopt;
}

/// The least or largest period or energy between two positions, if it lies within; none where it stands out of what
/// the quantity scatters by rounding so little that it may be none: `why` then says so. `sense`: of `sense_of_turn`.
std::optional<numerics::Located> extremum(const systems::System& system, continuation::FamilyCurve& family,
                                          const Event& event, double from, double to, int sense, double tolerance,
                                          NotLocated& why) {
  const auto of = [&](const loop::Loop& loop) { return turning(system, event.kind, loop); };
  const auto quantity = [&](double position) {
    if (const std::optional<continuation::CurvePoint> point = family.at(position)) return of(point->loop);
    const auto sides = both_sides(family, position, {from, to}, false);
    return sides ? 0.5 * (of(sides->front().loop) + of(sides->back().loop)) : std::numeric_limits<double>::quiet_NaN();
  };
  const double at_from = quantity(from);
  const double at_to = quantity(to);
  const double ends = 0.5 * (at_from + at_to);
  for (const double sign : {1.0, -1.0}) {  // the least first
    if (sign * sense > 0.0) continue;
    std::optional<numerics::Located> found = numerics::locate_minimum(
        [&](double position) { return sign * (quantity(position) - ends); }, from, to, tolerance);
    const double margin = off_ends * (to - from);
    if (!found || !(found->position > from + margin && found->position < to - margin)) continue;
    const double least = quantity(found->position);
    double scatter = std::numeric_limits<double>::epsilon() * std::abs(least);
    for (const double share : scattering) {
      const double there = quantity(found->position + share * (to - from));
      if (!std::isnan(there)) scatter = std::max(scatter, std::abs(there - least));
    }
    // Below 0 where it turns again on the way to an end.
    const double rise = std::min(sign * (at_from - least), sign * (at_to - least));
    if (std::abs(rise) > clear_rise * scatter) return found;
    why = {.reason = NotLocated::Reason::unclear_fold, .at_from = rise, .at_to = scatter, .position = found->position};
    if (const auto point = family.at(found->position)) why.period = point->loop.period;
  }
  return std::nullopt;
}

/// Of a slope: only where it is less than at the ends, and no more than rounding.
std::optional<numerics::Located> root_of_slope(EventFunction& slope_at, const Interval& within, double tolerance) {
  std::optional<numerics::Located> located = root_of(slope_at, within, tolerance);
  const auto size = [&](double position) { return std::abs(slope_at(position)); };
  if (located && size(located->position) > left_of_slope * std::min(size(within.from), size(within.to)))
    located.reset();
  return located;
}

}  // namespace

std::optional<numerics::Located> turn(const systems::System& system, continuation::FamilyCurve& family,
                                      const Event& event, EventFunction& slope_at, const Interval& within,
                                      double tolerance, NotLocated& why) {
  why = {};
  if (auto located = root_of_slope(slope_at, within, tolerance)) return located;
  const int sense = sense_of_turn(system, family, event, within);
  if (const auto part = turning_part(slope_at, family, within, sense))
    if (auto located = root_of_slope(slope_at, *part, tolerance)) return located;
  const auto located = extremum(system, family, event, within.from, within.to, sense, tolerance, why);
  if (!located) return located;
  const double margin = off_ends * (within.to - within.from);
  const auto exact = root_of_slope(slope_at, {located->position - margin, located->position + margin}, tolerance);
  const auto most = family.at(located->position);
  const auto there = exact ? family.at(exact->position) : std::nullopt;
  if (!most || !there) return located;
  const double value = turning(system, event.kind, most->loop);
  const double rounding = as_extreme * std::numeric_limits<double>::epsilon() * std::abs(value);
  return std::abs(turning(system, event.kind, there->loop) - value) <= rounding ? exact : located;
}

}  // namespace orbweaver::bifurcation
