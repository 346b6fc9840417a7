#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::bifurcation {

/// Positions along a family.
struct Interval {
  double from;
  double to;
};

/// The orbits as far before a place as behind it, on one grid: what is smooth is their mean there, to the square of the
/// distance. Tangents are not: beside a crossing they may hold a part of the other family's.
[[nodiscard]] std::optional<std::array<continuation::CurvePoint, 2>> both_sides(continuation::FamilyCurve& family,
                                                                                double position, const Interval& within,
                                                                                bool with_tangent);

/// The family's unit direction at a place by the orbits on both sides of it, where these say another one than
/// `tangent`; else that. At a branch point the equations leave it open: any part of the other family's may be in it.
[[nodiscard]] loop::Tangent settled_direction(continuation::FamilyCurve& family, const continuation::CurvePoint& point,
                                              const Interval& within);

/// What turns at a fold.
[[nodiscard]] double turning(const systems::System& system, Event::Kind kind, const loop::Loop& loop);

/// What is zero at an event, by positions along the family: a test function, or the slope of what folds. NaN where it
/// has no value.
class EventFunction {
 public:
  EventFunction(const systems::System& system, continuation::FamilyCurve& family, const Event& event,
                const Interval& within)
      : _system(system), _family(family), _event(event), _within(within) {}

  double operator()(double position) { return reading(position).value; }

  /// The function with its error bound; a slope has none.
  Reading reading(double position);

  /// Where it is known.
  [[nodiscard]] std::vector<double> asked() const;

  /// Period, energy and parameter of an orbit, NaN where there are none.
  using Levels = std::array<double, 3>;
  /// Of all orbits that were asked for.
  [[nodiscard]] const std::map<double, Levels>& seen() const { return _seen; }

  /// How far the nearest index is from the sector's value at a place where the function is known; 0 of other functions.
  [[nodiscard]] double size_at(double position) const;

  /// The function over indices up to `size` at a place where it is known (`value_over`).
  [[nodiscard]] double known_over(double position, double size) const;

  /// `Stability::twist`, whose entries of the map are off by no more than its trace.
  Reading twist_at(double position);
  Reading deviation_at(double position);
  /// What turns at a fold.
  double turning_at(double position);

  /// Why the function had no value where it was asked for last without one.
  [[nodiscard]] const std::optional<NotLocated>& without_value() const { return _without_value; }

  /// `whole`: with the tangent and the multipliers also where the function does not need them. `tells_birth`: with what
  /// is known of the index at a birth.
  std::optional<Crossing> at(double position, bool whole = false, bool tells_birth = false);

 private:
  std::optional<Crossing> without_value(NotLocated::Reason reason, double position, double period,
                                        std::string detail = "");
  [[nodiscard]] double period_before(double position) const;
  [[nodiscard]] bool is_birth(double position) const { return _event.from_birth && position == _within.from; }

  /// Of test functions with the stability that it follows from.
  struct Known {
    Reading reading;
    spectrum::Stability stability;
  };

  const systems::System& _system;
  continuation::FamilyCurve& _family;
  const Event& _event;
  Interval _within;
  std::map<double, Known> _known;  // by position
  std::map<double, Levels> _seen;
  std::optional<NotLocated> _without_value;
};

/// Values that move the place by less than a share of `tolerance` are zero. Where indices are large at both ends the
/// search goes by the function over such indices; where that leads to a place without an orbit, by the function.
[[nodiscard]] std::optional<numerics::Located> root_of(EventFunction& function, const Interval& within,
                                                       double tolerance);

}  // namespace orbweaver::bifurcation
