#include "orbweaver/continuation/family_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curve_interval.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {

FamilyCurve::FamilyCurve(std::shared_ptr<const systems::System> system, loop::Isotropy isotropy, const Options& options)
    : _system(std::move(system)), _isotropy(std::move(isotropy)), _options(options) {}
FamilyCurve::~FamilyCurve() = default;

void FamilyCurve::add(double position, const loop::Loop& loop, std::size_t keep) {
  core::require(_known.empty() || position > _known.back().position, "orbits of a family are added in their order");
  _known.push_back({position, loop});
  if (_known.size() > keep) _known.erase(_known.begin());
  _intervals.clear();
}

void FamilyCurve::forget_found() { _intervals.clear(); }

std::optional<CurvePoint> FamilyCurve::at(double position, bool with_tangent) {
  core::require(_known.size() >= 2 && position >= _known.front().position && position <= _known.back().position,
                "a position outside the known part of a family");
  if (_before_each) _before_each();
  std::size_t last = 1;
  while (position > _known[last].position) ++last;
  std::unique_ptr<CurveInterval>& interval = _intervals[last];
  if (!interval) interval = std::make_unique<CurveInterval>(*_system, _isotropy, _options, _known, last);
  return interval->at(position, with_tangent);
}

}  // namespace orbweaver::continuation
