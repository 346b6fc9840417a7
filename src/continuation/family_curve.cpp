#include "orbweaver/continuation/family_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curve_interval.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {

FamilyCurve::FamilyCurve(std::shared_ptr<const systems::System> system, loop::Isotropy isotropy, const Options& options)
    : _system(std::move(system)), _isotropy(std::move(isotropy)), _options(options) {}
FamilyCurve::~FamilyCurve() = default;

void FamilyCurve::add(double position, const loop::Loop& loop, std::size_t keep) {
  Known next{position, loop, position};
  if (!_known.empty() && !_system->scales().are_one())
    next.arclength = _known.back().arclength + arclength_in_units(*_system, _known.back().loop, loop);
  add(next, keep);
}

void FamilyCurve::add(const Known& known, std::size_t keep) {
  core::require(_known.empty() || known.position > _known.back().position,
                "orbits of a family are added in their order");
  _known.push_back(known);
  if (_known.size() > keep) _known.erase(_known.begin());
  _intervals.clear();
}

void FamilyCurve::drop_behind(double position) {
  while (!_known.empty() && _known.back().position > position) _known.pop_back();
  _intervals.clear();
}

void FamilyCurve::forget_found() { _intervals.clear(); }

std::size_t FamilyCurve::interval_of(double position) const {
  core::require(_known.size() >= 2 && position >= _known.front().position && position <= _known.back().position,
                "a position outside the known part of a family");
  std::size_t last = 1;
  while (position > _known[last].position) ++last;
  return last;
}

double FamilyCurve::arclength_unit_at(double position) const {
  if (_system->scales().are_one() || _known.size() < 2) return 1.0;
  const std::size_t last = interval_of(position);
  const Known& from = _known[last - 1];
  const Known& to = _known[last];
  return (to.arclength - from.arclength) / (to.position - from.position);
}

double FamilyCurve::arclength_at(double position) const {
  if (_system->scales().are_one()) return position;
  if (_known.size() < 2 || position == _known.back().position) return _known.back().arclength;
  const Known& from = _known[interval_of(position) - 1];
  return from.arclength + arclength_unit_at(position) * (position - from.position);
}

std::optional<CurvePoint> FamilyCurve::at(double position, bool with_tangent) {
  const std::size_t last = interval_of(position);
  if (_before_each) _before_each();
  std::unique_ptr<CurveInterval>& interval = _intervals[last];
  if (!interval) interval = std::make_unique<CurveInterval>(*_system, _isotropy, _options, _known, last);
  std::optional<CurvePoint> found = interval->at(position, with_tangent);
  if (found || _known.size() == 2) return found;
  // Where a family turns sharply within the interval, orbits beyond lead away from it.
  const std::vector<Known> ends{_known[last - 1], _known[last]};
  return CurveInterval(*_system, _isotropy, _options, ends, 1).at(position, with_tangent);
}

}  // namespace orbweaver::continuation
