#include "orbweaver/continuation/family_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curve_interval.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {

loop::Loop under_map(const loop::Loop& loop, const loop::TimeMap& map, int cutoff) {
  if (loop.time_map == map) return loop::with_cutoff(loop, std::max(cutoff, loop.cutoff));
  const double allowed = std::max(1e-12, 2.0 * loop::tail(loop));
  int k = std::max(cutoff, loop.cutoff);
  loop::Loop out = loop::with_time_map(loop, map, k);
  while (loop::tail(out) > allowed && k < 4 * loop.cutoff) {
    k = loop::next_cutoff(loop::allowed_cutoff_at_least(k));
    out = loop::with_time_map(loop, map, k);
  }
  return out;
}

std::vector<double> lagrange_weights(const std::vector<double>& positions, double position, double length) {
  std::vector<std::size_t> nearest(positions.size());
  for (std::size_t n = 0; n < nearest.size(); ++n) nearest[n] = n;
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(positions[a] - position) < std::abs(positions[b] - position);
  });
  std::vector<std::size_t> used;  // well apart, so that their rounding is not amplified
  for (const std::size_t n : nearest) {
    const bool apart = std::all_of(used.begin(), used.end(), [&](std::size_t other) {
      return std::abs(positions[n] - positions[other]) > 1e-4 * length;
    });
    if (apart && used.size() < 4) used.push_back(n);
  }
  std::vector<double> weights(positions.size(), 0.0);
  for (const std::size_t n : used) {
    weights[n] = 1.0;
    for (const std::size_t other : used)
      if (other != n) weights[n] *= (position - positions[other]) / (positions[n] - positions[other]);
  }
  return weights;
}

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
  if (!interval) {
    const IntervalOf of{*_system, _isotropy, _options, _known, last};
    if (_options.corrector.method == corrector::Method::automatic) interval = make_collocation_interval(of);
    if (!interval) interval = make_loop_interval(of);
  }
  return interval->at(position, with_tangent);
}

}  // namespace orbweaver::continuation
