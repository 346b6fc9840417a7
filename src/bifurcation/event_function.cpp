#include "event_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "orbweaver/bifurcation/parted_crossings.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/bifurcation/stability_of_orbit.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

namespace {

/// How far beside a place without an orbit a fold's neighbours are taken, in parts of the interval in which it is
/// looked for, the first two that there are: a family may turn where it crosses another one, and there Newton's method
/// finds no orbit if it is asked for exactly that one.
constexpr double beside_singular[] = {1e-4, 1e-3, 1e-2};

/// How far beside a branch point orbits tell the family's direction, in parts of the interval: near enough that it does
/// not bend, far enough that rounding does not leave them open. And the cosine of the angle by which they say the same
/// as the equations. Not measured.
constexpr double beside_branch_point = 1e-2;
constexpr double same_direction = 0.999;

/// A value is zero that moves the place by this share of what it may be off, by the function's mean slope.
constexpr double negligible = 1e-2;

constexpr Reading none{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

double slope(const systems::System& system, Event::Kind kind, const continuation::CurvePoint& point) {
  if (kind == Event::Kind::fold_period) return period_slope(point);
  return kind == Event::Kind::fold_energy ? energy_slope(system, point) : parameter_slope(point);
}

}  // namespace

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

loop::Tangent settled_direction(continuation::FamilyCurve& family, const continuation::CurvePoint& point,
                                const Interval& within) {
  const double away = beside_branch_point * (within.to - within.from);
  const double from = std::max(within.from, point.position - away);
  const double to = std::min(within.to, point.position + away);
  const auto before = family.at(from);
  const auto behind = family.at(to);
  if (!before || !behind || !(before->loop.time_map == behind->loop.time_map) ||
      !(before->loop.time_map == point.loop.time_map))
    return point.tangent;
  const int cutoff = point.loop.cutoff;
  const loop::Loop a = loop::with_cutoff(before->loop, cutoff);
  const loop::Loop b = loop::with_cutoff(behind->loop, cutoff);
  loop::Tangent way = point.tangent;
  for (std::size_t n = 0; n < way.modes.size(); ++n) way.modes[n] = b.modes[n] - a.modes[n];
  for (std::size_t n = 0; n < way.scalars.size(); ++n)
    way.scalars[n] = n == 0 ? b.period - a.period : b.parameters[n - 1] - a.parameters[n - 1];
  if (!(way.norm() > 0.0)) return point.tangent;
  way.normalize();
  return loop::dot(way, point.tangent) > same_direction ? point.tangent : way;
}

double turning(const systems::System& system, Event::Kind kind, const loop::Loop& loop) {
  if (kind == Event::Kind::fold_parameter) return loop.parameters.front();
  return kind == Event::Kind::fold_period ? loop.period : continuation::energy_of(system, loop);
}

Reading EventFunction::reading(double position) {
  const auto known = _known.find(position);
  if (known != _known.end()) return known->second.reading;
  const std::optional<Crossing> there = at(position, false, is_birth(position));
  if (!there) return none;  // it says why each time that it is asked
  _known[position] = {there->reading, there->stability};
  return there->reading;
}

std::vector<double> EventFunction::asked() const {
  std::vector<double> positions;
  for (const auto& [position, there] : _known) positions.push_back(position);
  return positions;
}

double EventFunction::size_at(double position) const {
  if (_event.kind != Event::Kind::test_function || _event.is_parted || !has_sector(_event.function.kind)) return 0.0;
  return std::abs(index_deviation(_system.structure(), _known.at(position).stability, _event.function.sector).value);
}

double EventFunction::known_over(double position, double size) const {
  return value_over(_event.function, _system.structure(), _known.at(position).stability, size);
}

Reading EventFunction::twist_at(double position) {
  const std::optional<Crossing> there = at(position);
  return there ? Reading{there->stability.twist, there->stability.fundamental_error.front()} : none;
}

Reading EventFunction::deviation_at(double position) {
  const std::optional<Crossing> there = at(position);
  return there ? index_deviation(_system.structure(), there->stability, _event.function.sector) : none;
}

double EventFunction::turning_at(double position) {
  const std::optional<Crossing> there = at(position);
  return there ? turning(_system, _event.kind, there->point.loop) : none.value;
}

std::optional<Crossing> EventFunction::at(double position, bool whole, bool tells_birth) {
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
  const std::vector<double>& parameters = point->loop.parameters;
  _seen[position] = {point->loop.period, continuation::energy_of(_system, point->loop),
                     parameters.empty() ? none.value : parameters.front()};
  Crossing out;
  out.point = std::move(*point);
  const auto known = fold || is_birth(position) ? _known.end() : _known.find(position);
  if (known != _known.end()) out.stability = known->second.stability;
  if (known == _known.end() && (whole || !fold)) try {
      out.stability = stability_of(_system, out.point.loop, _family.isotropy(), _family.options().corrector.team);
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

std::optional<Crossing> EventFunction::without_value(NotLocated::Reason reason, double position, double period,
                                                     std::string detail) {
  _without_value = {.reason = reason, .position = position, .period = period, .detail = std::move(detail)};
  return std::nullopt;
}

double EventFunction::period_before(double position) const {
  double period = _family.known().front().loop.period;
  for (const continuation::FamilyCurve::Known& known : _family.known())
    if (known.position <= position) period = known.loop.period;
  return period;
}

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

}  // namespace orbweaver::bifurcation
