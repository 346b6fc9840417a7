#include "orbweaver/bifurcation/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "event_function.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "place_error.hpp"
#include "turn.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// How far beside a located zero the function is looked at, in parts of the interval, and what of its value there may
/// be left at the zero: of a smooth function it is about the share of the two distances, 1e-4 or less.
constexpr double beside_zero = 1e-4;
constexpr double left_at_zero = 0.1;
/// More than this share is not believed of a smooth function: then it is asked nearer to the zero, at a tenth and at a
/// hundredth of that distance, whether it falls towards it. Of a smooth function a tenth is left.
constexpr double smooth_at_zero = 1e-3;
constexpr double falls = 0.5;
/// How much wider each bracket around an uncertain zero is.
constexpr double wider = 4.0;
/// A place where an index touches is known so well, in parts of the interval, or to the second number.
constexpr double share_beside_touch = 1e-3;
constexpr double least_beside_touch = 1e-5;

bool has_determinant(const systems::System& system, const Event& event) {
  return event.function.kind == TestFunction::Kind::sector && event.function.sector.q <= 2 &&
         system.structure().symplectic;
}

/// A zero of an index less 2 or -2 that its error moves by `uncertain`, as beside another one: that of the determinant,
/// if it has one there.
std::optional<numerics::Located> sharpened(EventFunction& exact, const Interval& within, double zero, double uncertain,
                                           double tolerance) {
  for (double width = wider * uncertain; std::isfinite(width); width *= wider) {
    const Interval around{std::max(within.from, zero - width), std::min(within.to, zero + width)};
    const double ends = std::min(std::abs(exact(around.from)), std::abs(exact(around.to)));
    if (exact(around.from) * exact(around.to) < 0.0) {
      const auto sharp = root_of(exact, around, tolerance);
      const bool is_zero = sharp && std::abs(exact(sharp->position)) <= left_at_zero * ends;
      return is_zero ? sharp : std::nullopt;  // orbits of two families may meet there
    }
    if (around.from == within.from && around.to == within.to) break;
  }
  return std::nullopt;
}

/// The same of a place where an index touches 2 or -2: its square there is known to half the digits of the place.
std::optional<numerics::Located> sharpened_touch(EventFunction& exact, const Interval& within, double touch,
                                                 double tolerance) {
  const double half = std::max(share_beside_touch * (within.to - within.from), least_beside_touch);
  return numerics::locate_minimum([&](double position) { return std::abs(exact(position)); },
                                  std::max(within.from, touch - half), std::min(within.to, touch + half), tolerance);
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
  Event parted = event;
  parted.is_parted = true;
  EventFunction exact(system, family, parted, {from, to});
  // What is zero, by which the place is known, and where that has been asked.
  BoundedFunction zero = [&](double position) { return function.reading(position); };
  EventFunction* asked = &function;
  const auto enclosed = [&](double position) {
    return enclosure_of_zero(zero, asked->asked(), position, from, to, absolute);
  };
  const auto sharpen = [&](const std::optional<numerics::Located>& sharp) {
    if (!sharp) return;
    located = sharp;
    zero = [&](double position) { return exact.reading(position); };
    asked = &exact;
  };
  if (event.passed || event.is_double) {
    zero = [&](double position) {
      return event.passed ? function.twist_at(position) : function.deviation_at(position);
    };
    located = numerics::locate_root([&](double position) { return zero(position).value; }, from, to, absolute);
  } else if (event.tangency) {
    located =
        numerics::locate_minimum([&](double position) { return std::abs(function(position)); }, from, to, absolute);
    if (located && has_determinant(system, event))
      sharpen(sharpened_touch(exact, {from, to}, located->position, absolute));
  } else if (event.kind == Event::Kind::test_function) {
    located = root_of(function, {from, to}, absolute);
    if (located && !event.is_parted && has_determinant(system, event)) {
      const Enclosure around = enclosed(located->position);
      const double uncertain = std::max(around.before, around.behind);
      if (uncertain > absolute) sharpen(sharpened(exact, {from, to}, located->position, uncertain, absolute));
    }
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
  const Enclosure around = event.kind == Event::Kind::test_function
                               ? enclosed(located->position)
                               : enclosure_of_fold(function, located->position, {from, to}, absolute);
  crossing->place_error = place_error(*asked, family, located->position, function.seen().at(located->position), around);
  if (event.kind == Event::Kind::test_function && has_sector(event.function.kind) && event.function.sector.q == 1)
    crossing->point.tangent = settled_direction(family, crossing->point, {from, to});
  crossing->width = located->width;
  return crossing;
}

}  // namespace orbweaver::bifurcation
