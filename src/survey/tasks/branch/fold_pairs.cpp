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

/// Slopes are looked at where the change on a way is so much slower than on those beside it: steps that pass a pair of
/// folds resolve their quantity no better. Not measured.
constexpr double slower = 0.5;

/// One quantity on the way from the orbit `way` to the next.
class WayBetween {
 public:
  WayBetween(const systems::System& system, const std::vector<Known>& known, std::size_t way, Fold::Quantity quantity)
      : _system(system), _known(known), _way(way), _quantity(quantity), _rate(rate(way)) {
    _visible = visible_change(quantity, value(way));
  }

  [[nodiscard]] bool may_hide() const {
    return (!has_before() || is_slower_than(_way - 1)) && (!has_behind() || is_slower_than(_way + 1));
  }

  /// `curve`: of the known orbits.
  [[nodiscard]] std::vector<Fold> folds(continuation::FamilyCurve& curve, const loop::Isotropy& isotropy) const {
    const double from = position(_way);
    const double to = position(_way + 1);
    const std::optional<double> first = slope_at(curve, from);
    const std::optional<double> second = slope_at(curve, to);
    if (!first || !second) return {};
    std::optional<double> least;
    const auto is_told = [&](double slope) {  // rounding is asked only where a slope is against the changes
      if (!(std::abs(slope) > _visible / (to - from))) return false;
      if (!least) least = moved(isotropy);
      return std::abs(slope) > *least;
    };
    const bool turns_at_first = *first * _rate < 0.0 && is_told(*first);
    const bool turns_at_second = *second * _rate < 0.0 && is_told(*second);
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
  [[nodiscard]] bool has_before() const { return _way > 0; }
  [[nodiscard]] bool has_behind() const { return _way + 2 < _known.size(); }
  [[nodiscard]] double position(std::size_t n) const { return _known[n].position; }
  [[nodiscard]] double value(std::size_t n) const { return value_of(_system, _quantity, _known[n].loop); }
  [[nodiscard]] double rate(std::size_t way) const {
    return (value(way + 1) - value(way)) / (position(way + 1) - position(way));
  }
  [[nodiscard]] bool is_slower_than(std::size_t other) const {
    const double beside = rate(other);
    return beside * _rate > 0.0 && std::abs(_rate) < slower * std::abs(beside);
  }

  [[nodiscard]] std::optional<double> slope_at(continuation::FamilyCurve& curve, double position) const {
    const auto point = curve.at(position, true);
    if (!point || point->tangent.empty()) return std::nullopt;
    return slope_of(_system, _quantity, *point);
  }

  /// Whether the slope at an orbit has the sign of the changes from orbit to orbit.
  [[nodiscard]] bool is_plain(continuation::FamilyCurve& curve, std::size_t n) const {
    const auto slope = slope_at(curve, position(n));
    return slope && *slope * _rate > 0.0;
  }

  /// Between the two a place at which the slope is against those at both of them: where that of the cubic with these
  /// slopes is least.
  [[nodiscard]] std::optional<double> turned_between(continuation::FamilyCurve& curve, double first, double second,
                                                     const std::function<bool(double)>& is_told) const {
    const double bend = first + second - 2.0 * _rate;
    const double share = (2.0 * first + second - 3.0 * _rate) / (3.0 * bend);
    if (!(share > 0.0 && share < 1.0)) return std::nullopt;
    const double there = first + share * (6.0 * _rate - 4.0 * first - 2.0 * second) + 3.0 * share * share * bend;
    if (there * second > 0.0) return std::nullopt;
    const double place = position(_way) + share * (position(_way + 1) - position(_way));
    const auto slope = slope_at(curve, place);
    return slope && *slope * second < 0.0 && is_told(*slope) ? std::optional(place) : std::nullopt;
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
