#include "witness/passing.hpp"

#include <cmath>

namespace orbweaver::survey {

namespace {

constexpr double near = 1e-3;

bool passes(const TreeFamily& family, std::size_t segment, const PlaceOfOrbit& place) {
  const Invariants& a = family.curve.points()[segment];
  const Invariants& b = family.curve.points()[segment + 1];
  const auto change = [&](Invariant i) { return (b.value(i) - a.value(i)) / a.scale_of(i); };
  const double in_period = change(Invariant::period);
  const double in_level = change(Invariant::level);
  const bool by_level = std::abs(in_level) > std::abs(in_period);
  const double share = by_level
                           ? (place.level - a.value(Invariant::level)) / a.scale_of(Invariant::level) / in_level
                           : (place.period - a.value(Invariant::period)) / a.scale_of(Invariant::period) / in_period;
  const auto is_near = [&](Invariant i, double value) {
    const double between = a.value(i) + share * (b.value(i) - a.value(i));
    return !(std::abs(value - between) > near * a.scale_of(i));
  };
  return is_near(Invariant::period, place.period) && is_near(Invariant::level, place.level) &&
         is_near(Invariant::action, place.action);
}

}  // namespace

std::vector<CurveIndex::Segment> passing(const AtlasTree& tree, const CurveIndex& index, const PlaceOfOrbit& place) {
  std::vector<CurveIndex::Segment> found =
      index.near(place.period, place.level, near * place.period, near * place.level_scale);
  std::erase_if(found, [&](const CurveIndex::Segment& at) {
    return !passes(tree.families[static_cast<std::size_t>(at.family)], at.segment, place);
  });
  return found;
}

}  // namespace orbweaver::survey
