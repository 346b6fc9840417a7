#include "foldable.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/curve/system_at.hpp"

namespace orbweaver::survey {

using bifurcation::Fold;

namespace {

/// Relative to their size, of changes of T and E: ten times what the watch sees, for what differences of them are off.
constexpr double visible_part = 10.0 * bifurcation::FoldWatch::visible_change;
/// Relative to their size: a change that no rounding makes of an orbit that is told from its neighbours at all.
constexpr double evident_part = 1e-4;
/// What roundings move is known from one set of them: others may move a quantity by so much more. Not measured.
constexpr double of_one_rounding = 10.0;

/// The largest change of a quantity with a length of orbits (that of continuation::arclength_between).
double steepest(const systems::System& system, Fold::Quantity quantity, const loop::Loop& orbit) {
  if (quantity == Fold::Quantity::parameter) return 1.0;
  if (quantity == Fold::Quantity::period) return orbit.period;
  std::vector<double> gradient(static_cast<std::size_t>(orbit.dimension));
  loop::system_at(system, orbit)->conserved_gradient(0, loop::state_at(orbit, 0.0), gradient);
  return std::sqrt(std::inner_product(gradient.begin(), gradient.end(), gradient.begin(), 0.0));
}

}  // namespace

std::vector<Fold::Quantity> foldable(const systems::System& system) {
  if (!system.family_scalars().free.empty()) return {Fold::Quantity::parameter};
  if (!system.structure().conservative()) return {Fold::Quantity::period};
  return {Fold::Quantity::period, Fold::Quantity::energy};
}

double value_of(const systems::System& system, Fold::Quantity quantity, const loop::Loop& loop) {
  if (quantity == Fold::Quantity::period) return loop.period;
  return quantity == Fold::Quantity::energy ? continuation::energy_of(system, loop) : loop.parameters.front();
}

double slope_of(const systems::System& system, Fold::Quantity quantity, const continuation::CurvePoint& point) {
  if (quantity == Fold::Quantity::period) return bifurcation::period_slope(point);
  return quantity == Fold::Quantity::energy ? bifurcation::energy_slope(system, point)
                                            : bifurcation::parameter_slope(point);
}

double visible_change(Fold::Quantity quantity, double value) {
  const double least = quantity == Fold::Quantity::parameter ? 1.0 : 0.0;  // a parameter may rest at 0
  return visible_part * std::max(std::abs(value), least);
}

double slope_left_open(const systems::System& system, const loop::Isotropy& isotropy, Fold::Quantity quantity,
                       const loop::Loop& orbit) {
  return continuation::left_open_by_rounding(system, orbit, isotropy).across * steepest(system, quantity, orbit);
}

double moved_by_rounding(const systems::System& system, Fold::Quantity quantity, const loop::Loop& orbit,
                         const continuation::LeftOpen& open) {
  const double moved = quantity == Fold::Quantity::period   ? open.period
                       : quantity == Fold::Quantity::energy ? open.energy
                                                            : open.parameter;
  return of_one_rounding * moved + open.across * open.across * steepest(system, quantity, orbit);
}

double moved_by_rounding(const systems::System& system, const loop::Isotropy& isotropy, Fold::Quantity quantity,
                         const loop::Loop& orbit) {
  return moved_by_rounding(system, quantity, orbit, continuation::left_open_by_rounding(system, orbit, isotropy));
}

bool is_rounding(const systems::System& system, const loop::Isotropy& isotropy, Fold::Quantity quantity,
                 const bifurcation::FoldWatch::Turn& turn, const loop::Loop& orbit,
                 const std::vector<continuation::FamilyCurve::Known>& known) {
  const double change = value_of(system, quantity, orbit) - turn.value;
  if (std::isnan(change) || std::isnan(turn.position) || turn.direction * change > 0.0) return false;
  if (std::abs(change) <= bifurcation::FoldWatch::visible_change * turn.scale)
    return false;  // which the watch passes over
  if (std::abs(change) > evident_part * turn.scale) return false;
  if (std::abs(change) <= moved_by_rounding(system, isotropy, quantity, orbit)) return true;
  const auto before =
      std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.position == turn.position; });
  return before != known.end() && std::abs(change) <= moved_by_rounding(system, isotropy, quantity, before->loop);
}

}  // namespace orbweaver::survey
