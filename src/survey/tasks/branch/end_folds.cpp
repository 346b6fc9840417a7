#include "end_folds.hpp"

#include <algorithm>
#include <cmath>

#include "foldable.hpp"
#include "orbweaver/continuation/orbit.hpp"

namespace orbweaver::survey {

namespace {

using bifurcation::Fold;

/// Of the smaller of two slopes of unlike signs: how far the second may be from the line through the first and the one
/// before. Not measured.
constexpr double evenly = 0.1;
/// And of what rounding leaves of the family's slope at a place: how much steeper it has to be. Not measured.
constexpr double surely = 100.0;

class Way {
 public:
  Way(const systems::System& system, const loop::Isotropy& isotropy, const WayToEnd& way, Fold::Quantity quantity)
      : _system(system), _isotropy(isotropy), _way(way), _quantity(quantity) {
    for (const continuation::CurvePoint& point : way.points) _values.push_back(value(point.loop));
    _visible = visible_change(quantity, _values[0]);
    if (way.crossing) _values.push_back(value(*way.crossing));
  }

  void add_folds(std::vector<Fold>& folds) const {
    int before = 0;  // the sign of the slope at the place before, towards larger positions
    std::vector<Place> places;
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
      const bool is_told = beside == nullptr || std::abs(slope * (here.position - position)) > _visible;
      places.push_back({here.position, slope});
      if (!is_told && !are_on_a_line(places)) {
        places.pop_back();
        continue;
      }
      const int sign = slope > 0.0 ? 1 : -1;
      if (before * sign < 0) {
        const bool falls = position > here.position;
        const bool is_sure = std::abs(slope) > surely * slope_left_open(_system, _isotropy, _quantity, here.loop);
        if (!(is_sure && are_on_a_line(places)) &&
            (!is_shown(n, sign, falls, _visible) || is_open(n, sign, falls, here.loop, *beside)))
          return;
        folds.push_back({_quantity, std::min(position, here.position), std::max(position, here.position)});
      }
      before = sign;
      beside = &here.loop;
      position = here.position;
    }
  }

  /// Whether places behind the first one say what the slope there does.
  [[nodiscard]] bool bears_out() const {
    const continuation::CurvePoint& first = _way.points[0];
    const double slope = slope_of(_system, _quantity, first);
    const int sign = slope > 0.0 ? 1 : -1;
    if (!is_shown(0, sign, false, _visible)) return false;
    if (!_way.crossing) return std::abs(slope) > slope_left_open(_system, _isotropy, _quantity, first.loop);
    const double moved = moved_by_rounding(_system, _quantity, first.loop, left_open(first.loop));
    return is_shown(0, sign, false, std::max(_visible, moved));
  }

 private:
  struct Place {
    double position;
    double slope;
  };

  /// Whether the last three slopes change evenly: one that holds a part of another family's does not.
  [[nodiscard]] bool are_on_a_line(const std::vector<Place>& places) const {
    if (!_way.goes_through || places.size() < 3) return false;
    const Place& a = places[places.size() - 3];
    const Place& b = places[places.size() - 2];
    const Place& c = places.back();
    const double expected = b.slope + (b.slope - a.slope) * (c.position - b.position) / (b.position - a.position);
    return std::abs(c.slope - expected) < evenly * std::min(std::abs(b.slope), std::abs(c.slope));
  }

  [[nodiscard]] double value(const loop::Loop& loop) const { return value_of(_system, _quantity, loop); }

  /// Beside a crossing a tangent may hold a part of the other family's: the way from a place nearer to the end must say
  /// the same, by more than `visible`. `falls`: positions fall towards the end.
  [[nodiscard]] bool is_shown(std::size_t n, int sign, bool falls, double visible) const {
    const double towards = falls ? -1.0 : 1.0;
    const auto says_so = [&](double nearer) { return towards * sign * (nearer - _values[n]) > visible; };
    return !_way.crossing || std::any_of(_values.begin() + static_cast<std::ptrdiff_t>(n) + 1, _values.end(), says_so);
  }

  /// Whether rounding may have made what two orbits show, or leaves one of them open by more than they are apart.
  [[nodiscard]] bool is_open(std::size_t n, int sign, bool falls, const loop::Loop& one,
                             const loop::Loop& other) const {
    const continuation::LeftOpen first = left_open(one);
    const continuation::LeftOpen second = left_open(other);
    const double moved = std::max(moved_by_rounding(_system, _quantity, one, first),
                                  moved_by_rounding(_system, _quantity, other, second));
    return !is_shown(n, sign, falls, std::max(_visible, moved)) ||
           std::max(first.across, second.across) > continuation::arclength_between(one, other);
  }

  [[nodiscard]] continuation::LeftOpen left_open(const loop::Loop& orbit) const {
    return continuation::left_open_by_rounding(_system, orbit, _isotropy);
  }

  const systems::System& _system;
  const loop::Isotropy& _isotropy;
  const WayToEnd& _way;
  Fold::Quantity _quantity;
  std::vector<double> _values;  // at the places and at the crossing
  double _visible = 0.0;
};

}  // namespace

std::vector<Fold> folds_on(const systems::System& system, const loop::Isotropy& isotropy, const WayToEnd& way) {
  std::vector<Fold> folds;
  if (way.points.empty()) return folds;
  for (const Fold::Quantity quantity : foldable(system)) Way(system, isotropy, way, quantity).add_folds(folds);
  return folds;
}

std::vector<Fold> borne_out(const systems::System& system, const loop::Isotropy& isotropy, std::vector<Fold> folds,
                            const WayToEnd& way) {
  std::erase_if(folds, [&](const Fold& fold) { return !Way(system, isotropy, way, fold.quantity).bears_out(); });
  return folds;
}

bifurcation::FoldWatch::Slopes slopes_at(const systems::System& system, const continuation::CurvePoint& point) {
  bifurcation::FoldWatch::Slopes slopes;
  for (const Fold::Quantity quantity : foldable(system)) {
    double& slope = quantity == Fold::Quantity::period   ? slopes.period
                    : quantity == Fold::Quantity::energy ? slopes.energy
                                                         : slopes.parameter;
    slope = slope_of(system, quantity, point);
  }
  return slopes;
}

}  // namespace orbweaver::survey
