#include "end_folds.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/left_open.hpp"
#include "orbweaver/continuation/orbit.hpp"

namespace orbweaver::survey {

namespace {

using bifurcation::Fold;

/// Relative to their size, of changes of T and E: ten times what a fold is seen by (bifurcation/fold_watch), for
/// what differences of them are off.
constexpr double visible_change = 1e-9;

double slope_of(const systems::System& system, Fold::Quantity quantity, const continuation::CurvePoint& point) {
  if (quantity == Fold::Quantity::period) return bifurcation::period_slope(point);
  return quantity == Fold::Quantity::energy ? bifurcation::energy_slope(system, point)
                                            : bifurcation::parameter_slope(point);
}

double value_of(const systems::System& system, Fold::Quantity quantity, const loop::Loop& loop) {
  if (quantity == Fold::Quantity::period) return loop.period;
  return quantity == Fold::Quantity::energy ? continuation::energy_of(system, loop) : loop.parameters.front();
}

/// Whether rounding leaves one of two orbits open by more than they are apart.
bool are_hidden(const systems::System& system, const loop::Isotropy& isotropy, const loop::Loop& one,
                const loop::Loop& other) {
  const double apart = continuation::arclength_between(one, other);
  return std::max(continuation::left_open_by_rounding(system, one, isotropy),
                  continuation::left_open_by_rounding(system, other, isotropy)) > apart;
}

class Way {
 public:
  Way(const systems::System& system, const loop::Isotropy& isotropy, const WayToEnd& way, Fold::Quantity quantity)
      : _system(system), _isotropy(isotropy), _way(way), _quantity(quantity) {
    for (const continuation::CurvePoint& point : way.points) _values.push_back(value(point.loop));
    const double least = quantity == Fold::Quantity::parameter ? 1.0 : 0.0;  // a parameter may rest at 0
    _visible = visible_change * std::max(std::abs(_values[0]), least);
    if (way.crossing) _values.push_back(value(*way.crossing));
  }

  void add_folds(std::vector<Fold>& folds) const {
    int before = 0;  // the sign of the slope at the place before, towards larger positions
    const loop::Loop* beside = nullptr;
    double position = 0.0;
    if (_way.inner) {
      beside = &_way.inner->loop;
      position = _way.inner->position;
      const double change = value(*beside) - _values[0];
      if (std::abs(change) > _visible) before = (change > 0.0) == (position > _way.points[0].position) ? 1 : -1;
    }
    for (std::size_t n = 0; n < _way.points.size(); ++n) {
      const continuation::CurvePoint& here = _way.points[n];
      const double slope = slope_of(_system, _quantity, here);
      if (beside != nullptr && !(std::abs(slope * (here.position - position)) > _visible)) continue;
      const int sign = slope > 0.0 ? 1 : -1;
      if (before * sign < 0) {
        if (!is_shown(n, sign, position > here.position) || are_hidden(_system, _isotropy, here.loop, *beside)) return;
        folds.push_back({_quantity, std::min(position, here.position), std::max(position, here.position)});
      }
      before = sign;
      beside = &here.loop;
      position = here.position;
    }
  }

 private:
  [[nodiscard]] double value(const loop::Loop& loop) const { return value_of(_system, _quantity, loop); }

  /// Beside a crossing a tangent may hold a part of the other family's: the way from a place nearer to the end must say
  /// the same. `falls`: positions fall towards the end.
  [[nodiscard]] bool is_shown(std::size_t n, int sign, bool falls) const {
    const double towards = falls ? -1.0 : 1.0;
    const auto says_so = [&](double nearer) { return towards * sign * (nearer - _values[n]) > _visible; };
    return !_way.crossing || std::any_of(_values.begin() + static_cast<std::ptrdiff_t>(n) + 1, _values.end(), says_so);
  }

  const systems::System& _system;
  const loop::Isotropy& _isotropy;
  const WayToEnd& _way;
  Fold::Quantity _quantity;
  std::vector<double> _values;  // at the places and at the crossing
  double _visible = 0.0;
};

std::vector<Fold::Quantity> quantities_of(const systems::System& system) {
  if (!system.family_scalars().free.empty()) return {Fold::Quantity::parameter};
  if (!system.structure().conservative()) return {Fold::Quantity::period};
  return {Fold::Quantity::period, Fold::Quantity::energy};
}

}  // namespace

std::vector<Fold> folds_on(const systems::System& system, const loop::Isotropy& isotropy, const WayToEnd& way) {
  std::vector<Fold> folds;
  if (way.points.empty()) return folds;
  for (const Fold::Quantity quantity : quantities_of(system)) Way(system, isotropy, way, quantity).add_folds(folds);
  return folds;
}

bifurcation::FoldWatch::Slopes slopes_at(const systems::System& system, const continuation::CurvePoint& point) {
  bifurcation::FoldWatch::Slopes slopes;
  for (const Fold::Quantity quantity : quantities_of(system)) {
    double& slope = quantity == Fold::Quantity::period   ? slopes.period
                    : quantity == Fold::Quantity::energy ? slopes.energy
                                                         : slopes.parameter;
    slope = slope_of(system, quantity, point);
  }
  return slopes;
}

}  // namespace orbweaver::survey
