#include "fold_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "foldable.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

namespace {

using bifurcation::Fold;
using Known = continuation::FamilyCurve::Known;

/// Slopes are looked at where the change on a way is slower than this times the geometric mean of those beside it: a
/// pair of folds holds up what would else go on evenly. Not measured.
constexpr double slower = 0.8;
/// Where the cubic through the ends has a slope of less than this share of theirs, it is asked what the slope there is.
constexpr double dipping = 0.5;
constexpr int most_splits = 4;  ///< of a way at such places, one within the other

/// One quantity on the way from the orbit `way` to the next.
class WayBetween {
 public:
  WayBetween(const systems::System& system, const std::vector<Known>& known, std::size_t way, Fold::Quantity quantity)
      : _system(system), _known(known), _way(way), _quantity(quantity), _rate(rate(way)) {
    _visible = visible_change(quantity, value(way));
  }

  [[nodiscard]] bool may_hide() const {
    const double before = has_before() ? rate(_way - 1) : rate(_way + 1);
    const double behind = has_behind() ? rate(_way + 1) : before;
    return before * _rate > 0.0 && behind * _rate > 0.0 && _rate * _rate < slower * slower * before * behind;
  }

  /// `curve`: of the known orbits.
  [[nodiscard]] std::vector<Fold> folds(continuation::FamilyCurve& curve, const loop::Isotropy& isotropy) const {
    const double from = position(_way);
    const double to = position(_way + 1);
    const std::optional<Place> first = place_at(curve, from);
    const std::optional<Place> second = place_at(curve, to);
    if (!first || !second) return {};
    std::optional<double> least;
    const auto is_told = [&](const Place& place) {  // rounding is asked only where a slope is against the changes
      if (!(std::abs(place.slope) > _visible / (to - from))) return false;
      if (!least) least = moved(isotropy);
      return std::abs(place.slope) * place.advance > *least;
    };
    const bool turns_at_first = first->slope * _rate < 0.0 && is_told(*first);
    const bool turns_at_second = second->slope * _rate < 0.0 && is_told(*second);
    if ((turns_at_first && !has_before()) || (turns_at_second && !has_behind())) return {};  // end_folds finds it
    std::vector<Fold> found;
    if (turns_at_first && is_plain(curve, _way - 1)) found.push_back({_quantity, position(_way - 1), from});
    if (turns_at_first != turns_at_second) {
      found.push_back({_quantity, from, to});
    } else if (const auto between = turned_between(curve, *first, *second, is_told)) {
      found.push_back({_quantity, from, *between});
      found.push_back({_quantity, *between, to});
    }
    if (turns_at_second && is_plain(curve, _way + 2)) found.push_back({_quantity, to, position(_way + 2)});
    return found;
  }

 private:
  struct Place {
    double position;
    double value;
    double slope;    // with the position
    double advance;  // of CurvePoint
  };

  [[nodiscard]] bool has_before() const { return _way > 0; }
  [[nodiscard]] bool has_behind() const { return _way + 2 < _known.size(); }
  [[nodiscard]] double position(std::size_t n) const { return _known[n].position; }
  [[nodiscard]] double value(std::size_t n) const { return value_of(_system, _quantity, _known[n].loop); }
  [[nodiscard]] double rate(std::size_t way) const {
    return (value(way + 1) - value(way)) / (position(way + 1) - position(way));
  }
  [[nodiscard]] std::optional<Place> place_at(continuation::FamilyCurve& curve, double position) const {
    const auto point = curve.at(position, true);
    if (!point || point->tangent.empty()) return std::nullopt;
    return Place{position, value_of(_system, _quantity, point->loop),
                 slope_of(_system, _quantity, *point) / point->advance, point->advance};
  }

  /// Whether the slope at an orbit has the sign of the changes from orbit to orbit.
  [[nodiscard]] bool is_plain(continuation::FamilyCurve& curve, std::size_t n) const {
    const auto there = place_at(curve, position(n));
    return there && there->slope * _rate > 0.0;
  }

  /// Between the two, where their slopes have one sign, a place at which the slope has the other: sought where that of
  /// the cubic through both is least, and then between that place and each of them.
  [[nodiscard]] std::optional<double> turned_between(continuation::FamilyCurve& curve, const Place& first,
                                                     const Place& second,
                                                     const std::function<bool(const Place&)>& is_told,
                                                     int splits = most_splits) const {
    if (first.slope * second.slope < 0.0) return std::nullopt;
    const double rate = (second.value - first.value) / (second.position - first.position);
    const double bend = first.slope + second.slope - 2.0 * rate;
    const double share = (2.0 * first.slope + second.slope - 3.0 * rate) / (3.0 * bend);
    if (!(share > 0.0 && share < 1.0)) return std::nullopt;
    const double there =
        first.slope + share * (6.0 * rate - 4.0 * first.slope - 2.0 * second.slope) + 3.0 * share * share * bend;
    const double towards = first.slope > 0.0 ? 1.0 : -1.0;
    if (towards * there > dipping * std::min(std::abs(first.slope), std::abs(second.slope))) return std::nullopt;
    const auto between = place_at(curve, first.position + share * (second.position - first.position));
    if (!between) return std::nullopt;
    if (towards * between->slope < 0.0) return is_told(*between) ? std::optional(between->position) : std::nullopt;
    if (splits == 0) return std::nullopt;
    if (const auto before = turned_between(curve, first, *between, is_told, splits - 1)) return before;
    return turned_between(curve, *between, second, is_told, splits - 1);
  }

  /// Of slopes, by rounding, at the two orbits.
  [[nodiscard]] double moved(const loop::Isotropy& isotropy) const {
    return std::max(slope_left_open(_system, isotropy, _quantity, _known[_way].loop),
                    slope_left_open(_system, isotropy, _quantity, _known[_way + 1].loop));
  }

  const systems::System& _system;
  const std::vector<Known>& _known;
  std::size_t _way;
  Fold::Quantity _quantity;
  double _rate;
  double _visible = 0.0;
};

}  // namespace

std::vector<Fold> paired_folds(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                               const continuation::Options& options, const std::vector<Known>& known, std::size_t way) {
  core::require(known.size() > 2 && way + 1 < known.size(), "paired folds: a way beside another is wanted");
  std::vector<Fold> folds;
  for (const Fold::Quantity quantity : foldable(*system)) {
    const WayBetween here(*system, known, way, quantity);
    if (!here.may_hide()) continue;
    continuation::FamilyCurve curve(system, isotropy, options);  // what others find does not hang on what is asked here
    for (const Known& one : known) curve.add(one);
    for (const Fold& fold : here.folds(curve, isotropy)) folds.push_back(fold);
  }
  return folds;
}

}  // namespace orbweaver::survey
