#include "orbweaver/bifurcation/crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/bifurcation/parted_crossings.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// An extremum nearer than this share to an end of the interval is the end's: Brent's method stops there where the
/// function has none within.
constexpr double off_ends = 1e-3;

/// A value is zero that moves the place by this share of what it may be off, by the function's mean slope.
constexpr double negligible = 1e-2;
/// How far beside a located zero the function is looked at, in parts of the interval, and what of its value there may
/// be left at the zero: of a smooth function it is about the share of the two distances, 1e-4 or less.
constexpr double beside_zero = 1e-4;
constexpr double left_at_zero = 0.1;
/// More than this share is not believed of a smooth function: then it is asked nearer to the zero, at a tenth and at a
/// hundredth of that distance, whether it falls towards it. Of a smooth function a tenth is left.
constexpr double smooth_at_zero = 1e-3;
constexpr double falls = 0.5;
/// Of its error, what a value must be to tell a slope, and how much wider each bracket around an uncertain zero is.
constexpr double told = 100.0;
constexpr double wider = 4.0;
/// A place where an index touches is known so well, in parts of the interval, or to the second number.
constexpr double share_beside_touch = 1e-3;
constexpr double least_beside_touch = 1e-5;

/// How far beside a place without an orbit a fold's neighbours are taken, in parts of the interval in which it is
/// looked for, the first two that there are: a family may turn where it crosses another one, and there Newton's method
/// finds no orbit if it is asked for exactly that one.
constexpr double beside_singular[] = {1e-4, 1e-3, 1e-2};

/// A slope that is zero by its signs alone, and at the zero more than this share of those at the ends, is rounding's.
constexpr double left_of_slope = 1e-2;
/// What a period or an energy rises to both ends from where it is least must be so many times what it scatters there:
/// within this share of the interval, over which it would rise by its square.
constexpr double clear_rise = 10.0;
constexpr double scattering[] = {-2e-6, -1e-6, 1e-6, 2e-6};
/// What turns differs by so many roundings between the place where its slope vanishes and that where it is extreme, at
/// most.
constexpr double as_extreme = 16.0;

struct Interval {
  double from;
  double to;
};

/// The orbits as far before a place as behind it, on one grid: what is smooth is their mean there, to the square of the
/// distance. Tangents are not: beside a crossing they may hold a part of the other family's.
std::optional<std::array<continuation::CurvePoint, 2>> both_sides(continuation::FamilyCurve& family, double position,
                                                                  const Interval& within, bool with_tangent) {
  for (const double share : beside_singular) {
    const double away = share * (within.to - within.from);
    if (position - away < within.from || position + away > within.to) break;
    auto before = family.at(position - away, with_tangent);
    auto behind = before ? family.at(position + away, with_tangent) : std::nullopt;
    if (behind && before->loop.time_map == behind->loop.time_map)
      return std::array{*std::move(before), *std::move(behind)};
  }
  return std::nullopt;
}

/// What turns at a fold.
double turning(const systems::System& system, Event::Kind kind, const loop::Loop& loop) {
  if (kind == Event::Kind::fold_parameter) return loop.parameters.front();
  return kind == Event::Kind::fold_period ? loop.period : continuation::energy_of(system, loop);
}

double slope(const systems::System& system, Event::Kind kind, const continuation::CurvePoint& point) {
  if (kind == Event::Kind::fold_period) return period_slope(point);
  return kind == Event::Kind::fold_energy ? energy_slope(system, point) : parameter_slope(point);
}

class EventFunction {
 public:
  EventFunction(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                const Interval& within)
      : _system(system), _family(family), _event(event), _within(within) {}

  double operator()(double position) {
    const auto known = _known.find(position);
    if (known != _known.end()) return known->second.value;
    const std::optional<Crossing> there = at(position, false, is_birth(position));
    if (!there) return nan;  // it says why each time that it is asked
    _known[position] = {there->reading.value, there->stability};
    return there->reading.value;
  }

  /// How far the nearest index is from the sector's value at a place where the function is known; 0 of other functions.
  [[nodiscard]] double size_at(double position) const {
    if (_event.kind != Event::Kind::test_function || _event.is_parted || !has_sector(_event.function.kind)) return 0.0;
    return std::abs(index_deviation(_system.structure(), _known.at(position).stability, _event.function.sector).value);
  }

  /// The function over indices up to `size` at a place where it is known (`value_over`).
  [[nodiscard]] double known_over(double position, double size) const {
    return value_over(_event.function, _system.structure(), _known.at(position).stability, size);
  }

  /// How far the function's error at a zero may move it: the slope is taken to the nearest value that is told.
  double uncertainty_at(double position) {
    const std::optional<Crossing> zero = at(position);
    if (!zero || !(zero->reading.error > 0.0)) return 0.0;
    double away = std::numeric_limits<double>::infinity();
    double slope = 0.0;
    for (const auto& [other, there] : _known)
      if (std::abs(there.value) > told * zero->reading.error && std::abs(other - position) < away) {
        away = std::abs(other - position);
        slope = std::abs(there.value) / away;
      }
    return zero->reading.error / slope;
  }

  double twist_at(double position) {
    const std::optional<Crossing> there = at(position);
    return there ? there->stability.twist : nan;
  }

  double deviation_at(double position) {
    const std::optional<Crossing> there = at(position);
    return there ? index_deviation(_system.structure(), there->stability, _event.function.sector).value : nan;
  }

  /// Why the function had no value where it was asked for last without one.
  [[nodiscard]] const std::optional<NotLocated>& without_value() const { return _without_value; }

  /// `whole`: with the tangent and the multipliers also where the function does not need them. `tells_birth`: with what
  /// is known of the index at a birth.
  std::optional<Crossing> at(double position, bool whole = false, bool tells_birth = false) {
    const bool fold = _event.kind != Event::Kind::test_function;
    std::optional<continuation::CurvePoint> point = _family.at(position, whole || fold);
    std::optional<Reading> slope_between;
    if (!point && fold)
      if (auto sides = both_sides(_family, position, _within, true)) {
        const auto& [before, behind] = *sides;
        slope_between = {(turning(_system, _event.kind, behind.loop) - turning(_system, _event.kind, before.loop)) /
                             (behind.position - before.position),
                         0.0};
        point = {position, loop::weighted_sum({&before.loop, &behind.loop}, {0.5, 0.5}), {}};
        point->tangent = loop::with_cutoff(before.tangent, point->loop.cutoff, point->loop.dimension);
      }
    if (!point) return without_value(NotLocated::Reason::no_orbit, position, period_before(position));
    Crossing out;
    out.point = std::move(*point);
    const auto known = fold || is_birth(position) ? _known.end() : _known.find(position);
    if (known != _known.end()) out.stability = known->second.stability;
    if (known == _known.end() && (whole || !fold)) try {
        spectrum::FloquetOptions options;
        options.team = _family.options().corrector.team;
        out.stability = spectrum::floquet(_system, out.point.loop, _family.isotropy(), options);
      } catch (const core::NumericalError& error) {
        if (_event.kind == Event::Kind::test_function)
          return without_value(NotLocated::Reason::no_multipliers, position, out.point.loop.period, error.what());
      }
    if (tells_birth) tell_birth(_system.structure(), out.stability);
    if (_event.kind == Event::Kind::test_function)
      out.reading = _event.is_parted ? determinant_deviation(_system.structure(), out.stability, _event.function.sector)
                                     : evaluate(_event.function, _system.structure(), out.stability);
    else
      out.reading = slope_between ? *slope_between : Reading{slope(_system, _event.kind, out.point), 0.0};
    if (std::isnan(out.reading.value))
      return without_value(NotLocated::Reason::no_value, position, out.point.loop.period);
    return out;
  }

 private:
  std::optional<Crossing> without_value(NotLocated::Reason reason, double position, double period,
                                        std::string detail = "") {
    _without_value = {.reason = reason, .position = position, .period = period, .detail = std::move(detail)};
    return std::nullopt;
  }

  [[nodiscard]] double period_before(double position) const {
    double period = _family.known().front().loop.period;
    for (const continuation::FamilyCurve::Known& known : _family.known())
      if (known.position <= position) period = known.loop.period;
    return period;
  }

  [[nodiscard]] bool is_birth(double position) const { return _event.from_birth && position == _within.from; }

  /// Of test functions with the stability that it follows from.
  struct Known {
    double value;
    spectrum::Stability stability;
  };

  const systems::System& _system;
  continuation::FamilyCurve& _family;
  const Event& _event;
  Interval _within;
  std::map<double, Known> _known;  // by position
  std::optional<NotLocated> _without_value;
};

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
    return sides ? 0.5 * (of(sides->front().loop) + of(sides->back().loop)) : nan;
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

/// Values that move the place by less than a share of `tolerance` are zero. Where indices are large at both ends the
/// search goes by the function over such indices; where that leads to a place without an orbit, by the function.
std::optional<numerics::Located> root_of(EventFunction& function, const Interval& within, double tolerance) {
  const auto [from, to] = within;
  const double at_from = function(from);
  const double at_to = function(to);
  if (std::isnan(at_from) || std::isnan(at_to)) return std::nullopt;
  const double no_more = negligible * tolerance * std::abs(at_to - at_from) / (to - from);
  const auto search = [&](double size) {
    const auto along = [&](double position) {
      const double value = function(position);
      if (std::abs(value) <= no_more) return 0.0;
      return size > 0.0 && !std::isnan(value) ? function.known_over(position, size) : value;
    };
    return numerics::locate_root(along, from, to, tolerance);
  };
  const double size = std::min(function.size_at(from), function.size_at(to));
  const std::optional<numerics::Located> root = search(size);
  return root || !(size > 0.0) ? root : search(0.0);
}

bool has_determinant(const systems::System& system, const Event& event) {
  return event.function.kind == TestFunction::Kind::sector && event.function.sector.q <= 2 &&
         system.structure().symplectic;
}

/// A zero of an index less 2 or -2 that its error moves by more than `tolerance`, as beside another one: that of the
/// determinant, if it has one there.
numerics::Located sharpened(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                            EventFunction& function, const Interval& within, const numerics::Located& zero,
                            double tolerance) {
  if (event.is_parted || !has_determinant(system, event)) return zero;
  const double uncertain = function.uncertainty_at(zero.position);
  if (!(uncertain > tolerance)) return zero;
  Event parted = event;
  parted.is_parted = true;
  EventFunction exact(system, family, parted, within);
  for (double width = wider * uncertain; std::isfinite(width); width *= wider) {
    const Interval around{std::max(within.from, zero.position - width), std::min(within.to, zero.position + width)};
    const double ends = std::min(std::abs(exact(around.from)), std::abs(exact(around.to)));
    if (exact(around.from) * exact(around.to) < 0.0) {
      const auto sharp = root_of(exact, around, tolerance);
      const bool is_zero = sharp && std::abs(exact(sharp->position)) <= left_at_zero * ends;
      return is_zero ? *sharp : zero;  // orbits of two families may meet there
    }
    if (around.from == within.from && around.to == within.to) break;
  }
  return zero;
}

/// The same of a place where an index touches 2 or -2: its square there is known to half the digits of the place.
numerics::Located sharpened_touch(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                                  const Interval& within, const numerics::Located& touch, double tolerance) {
  if (!has_determinant(system, event)) return touch;
  Event parted = event;
  parted.is_parted = true;
  EventFunction exact(system, family, parted, within);
  const double half = std::max(share_beside_touch * (within.to - within.from), least_beside_touch);
  return numerics::locate_minimum([&](double position) { return std::abs(exact(position)); },
                                  std::max(within.from, touch.position - half),
                                  std::min(within.to, touch.position + half), tolerance)
      .value_or(touch);
}

/// Of a slope: only where it is less than at the ends, and no more than rounding.
std::optional<numerics::Located> root_of_slope(EventFunction& slope_at, const Interval& within, double tolerance) {
  std::optional<numerics::Located> located = root_of(slope_at, within, tolerance);
  const auto size = [&](double position) { return std::abs(slope_at(position)); };
  if (located && size(located->position) > left_of_slope * std::min(size(within.from), size(within.to)))
    located.reset();
  return located;
}

/// Where a period, an energy or a parameter turns. Directions along the family may be uncertain: then its extremum is
/// looked for. That is known to half the digits only, and the slope's root beside it is taken if it is as extreme.
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

/// Whether the sign changes by a jump: at the zero the function is far more than its error bound, and about as large as
/// beside it, or on one side as large near it as further away: one of two families may come near the value by itself.
/// Orbits on either side belong to two families then, or rounding makes them what they are. Over intervals as short as
/// `smallest` nothing is asked: families as near as that count as crossing.
bool is_discontinuous(EventFunction& function, const Crossing& zero, double from, double to, double smallest) {
  const double value = std::abs(zero.reading.value);
  if (!(value > error_margin * zero.reading.error) || to - from <= smallest) return false;
  const double position = zero.point.position;
  const double away = beside_zero * (to - from);
  bool is_smooth = true;
  for (const double beside : {position - away, position + away}) {
    if (beside < from || beside > to) continue;
    const double there = std::abs(function(beside));
    if (value > left_at_zero * there) return true;
    is_smooth = is_smooth && !(value > smooth_at_zero * there);
  }
  const auto falls_towards_it = [&](double side) {
    if (position + side * away < from || position + side * away > to) return true;
    const double near = std::abs(function(position + 0.01 * side * away));
    return !(near > falls * std::abs(function(position + 0.1 * side * away)));
  };
  return !is_smooth && !(falls_towards_it(-1.0) && falls_towards_it(1.0));
}

}  // namespace

double period_slope(const continuation::CurvePoint& point) { return point.tangent.period(); }

double parameter_slope(const continuation::CurvePoint& point) {
  core::require(point.tangent.scalars.size() > 1, "a parameter folds where one moves");
  return point.tangent.scalars[1];
}

double energy_slope(const systems::System& system, const continuation::CurvePoint& point) {
  const std::vector<double> state = loop::state_at(point.loop, 0.0);
  const std::vector<double> change = loop::state_at(loop::perturbation(point.loop, point.tangent), 0.0);
  std::vector<double> gradient(state.size());
  loop::system_at(system, point.loop)->conserved_gradient(0, state, gradient);
  double slope = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) slope += gradient[i] * change[i];
  return slope;
}

double level_slope(const systems::System& system, const continuation::CurvePoint& point) {
  return system.family_scalars().free.empty() ? energy_slope(system, point) : parameter_slope(point);
}

void tell_birth(const systems::Structure& system, spectrum::Stability& birth) {
  std::fill(birth.fundamental_error.begin(), birth.fundamental_error.end(), 0.0);
  if (!system.symplectic || birth.fundamental.empty()) return;
  *std::min_element(birth.fundamental.begin(), birth.fundamental.end(),
                    [](const auto& x, const auto& y) { return std::abs(x - 2.0) < std::abs(y - 2.0); }) = 2.0;
}

Reading index_deviation(const systems::Structure& system, const spectrum::Stability& stability, const Sector& sector) {
  Reading nearest{nan, nan};
  double least = std::numeric_limits<double>::infinity();
  const double value = sector.value(system.symplectic);
  // Where energy is conserved without pairs the last one is the energy's own.
  const std::size_t count = stability.fundamental.size() - (system.conservative() && !system.symplectic ? 1 : 0);
  for (std::size_t n = 0; n < count; ++n) {
    const double deviation = stability.fundamental[n].real() - value;
    const double away = system.symplectic ? std::abs(deviation) : std::abs(stability.fundamental[n] - value);
    if (n > 0 && !(away < least)) continue;
    least = away;
    nearest = {deviation, stability.fundamental_error[n]};
  }
  return nearest;
}

std::string to_text(const NotLocated& why) {
  switch (why.reason) {
    case NotLocated::Reason::no_zero:
      return fmt::format("no zero between positions {:.9g} and {:.9g}, where the function is {:.3g} and {:.3g}",
                         why.from, why.to, why.at_from, why.at_to);
    case NotLocated::Reason::no_orbit:
      return fmt::format("no orbit converges at position {:.12g}, after the one with T = {:.12g}", why.position,
                         why.period);
    case NotLocated::Reason::no_multipliers:
      return fmt::format("no multipliers of the orbit with T = {:.12g} at position {:.12g}: {}", why.period,
                         why.position, why.detail);
    case NotLocated::Reason::no_value:
      return fmt::format(
          "the multipliers of the orbit with T = {:.12g} at position {:.12g} are so large that the test "
          "function is not a number",
          why.period, why.position);
    case NotLocated::Reason::no_crossing:
      return fmt::format(
          "at position {:.12g} (T = {:.12g}) the test function changes its sign by a jump: it comes no nearer to zero "
          "than {:.2g}, and its error bound is {:.2g}; no family crosses there",
          why.position, why.period, why.at_from, why.at_to);
    case NotLocated::Reason::no_event: return "two multipliers pass one another there: nothing leaves";
    case NotLocated::Reason::unclear_event:
      return fmt::format(
          "at position {:.12g} (T = {:.12g}) two multipliers are each other's inverse, and so nearly equal that their "
          "error bounds hide whether they are on the unit circle",
          why.position, why.period);
    case NotLocated::Reason::unclear_fold:
      return fmt::format(
          "at position {:.12g} (T = {:.12g}) what would turn there turns by {:.2g}, and neighbouring orbits scatter by "
          "{:.2g}: rounding hides whether it does",
          why.position, why.period, why.at_from, why.at_to);
  }
  return "unknown";
}

std::optional<Crossing> locate(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                               double from, double to, NotLocated& why, double tolerance) {
  EventFunction function(system, family, event, {from, to});
  constexpr double widest = 1e-10;  // what |index - value| <= |dk/ds| 1e-10 allows
  const double absolute = std::min(tolerance * (1.0 + std::max(std::abs(from), std::abs(to))), widest);
  std::optional<numerics::Located> located;
  if (event.passed) {
    located = numerics::locate_root([&](double position) { return function.twist_at(position); }, from, to, absolute);
  } else if (event.is_double) {
    located =
        numerics::locate_root([&](double position) { return function.deviation_at(position); }, from, to, absolute);
  } else if (event.tangency) {
    const auto size = [&](double position) { return std::abs(function(position)); };
    located = numerics::locate_minimum(size, from, to, absolute);
    if (located) located = sharpened_touch(system, family, event, {from, to}, *located, absolute);
  } else if (event.kind == Event::Kind::test_function) {
    located = root_of(function, {from, to}, absolute);
    if (located) located = sharpened(system, family, event, function, {from, to}, *located, absolute);
  } else {
    located = turn(system, family, event, function, {from, to}, absolute, why);
    if (!located && why.reason == NotLocated::Reason::unclear_fold) return std::nullopt;
  }
  if (!located) {
    const double at_from = function(from);
    const double at_to = function(to);
    why = function.without_value().value_or(NotLocated{NotLocated::Reason::no_zero, from, to, at_from, at_to});
    return std::nullopt;
  }
  std::optional<Crossing> crossing = function.at(located->position, true);
  if (!crossing) {
    why = function.without_value().value();
    return std::nullopt;
  }
  const bool is_zero = event.kind == Event::Kind::test_function && !event.tangency && !event.passed;
  const bool is_jump_from_birth = event.from_birth && located->position - from <= absolute &&
                                  std::abs(crossing->reading.value) > error_margin * crossing->reading.error;
  if (is_jump_from_birth ||
      (is_zero && is_discontinuous(function, *crossing, from, to, family.options().smallest_jump))) {
    why = {.reason = NotLocated::Reason::no_crossing,
           .at_from = std::abs(crossing->reading.value),
           .at_to = crossing->reading.error,
           .position = located->position,
           .period = crossing->point.loop.period};
    return std::nullopt;
  }
  if (event.kind == Event::Kind::test_function) {
    const std::optional<bool> is_one =
        is_event(event.function, system.structure(), crossing->stability, event.tangency);
    if (!is_one.value_or(false)) {
      why = {.reason = is_one ? NotLocated::Reason::no_event : NotLocated::Reason::unclear_event,
             .position = located->position,
             .period = crossing->point.loop.period};
      return std::nullopt;
    }
  }
  crossing->width = located->width;
  return crossing;
}

}  // namespace orbweaver::bifurcation
