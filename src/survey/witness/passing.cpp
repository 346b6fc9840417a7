#include "witness/passing.hpp"

#include <cstddef>
#include <limits>

namespace orbweaver::survey {

namespace {

constexpr double near = 1e-3;

/// Of the deviations that a fit allows, as an orbit's floor.
constexpr double of_floor = 1.0 / 3.0;

bool passes(const TreeFamily& family, std::size_t segment, const PlaceOfOrbit& place) {
  Invariants x;
  x.values.fill(std::numeric_limits<double>::quiet_NaN());
  x.scale = family.curve.points()[segment].scale;
  for (std::size_t i = 0; i < x.scale.size(); ++i) x.floor[i] = of_floor * near * x.scale[i];
  const auto set = [&](Invariant i, double value) { x.values[static_cast<std::size_t>(i)] = value; };
  set(Invariant::period, place.period);
  set(Invariant::level, place.level);
  set(Invariant::action, place.action);
  return family.curve.fit_near(x, segment, 0).fits();
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
