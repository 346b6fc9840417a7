#include "curve_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace orbweaver::survey {

namespace {

/// Cells in a factor e of the period: steps change T by a percent or so, which is a few cells.
constexpr double cells_per_factor = 512.0;

std::int64_t cell_of(double period) {
  return static_cast<std::int64_t>(std::floor(cells_per_factor * std::log(period)));
}

}  // namespace

std::pair<double, double> range_beyond(const std::vector<Invariants>& points, std::size_t segment, Invariant i) {
  double longest = 0.0;
  for (std::size_t n = segment > 0 ? segment - 1 : 0; n + 1 < points.size() && n <= segment + 1; ++n)
    longest = std::fmax(longest, std::abs(points[n + 1].value(i) - points[n].value(i)));
  const auto [from, to] = std::minmax({points[segment].value(i), points[segment + 1].value(i)});
  return {from - beyond_segment * longest, to + beyond_segment * longest};
}

bool CurveIndex::Range::overlaps(const Range& other, double in_period, double in_level) const {
  return !(other.period_to < period_from - in_period || other.period_from > period_to + in_period ||
           other.level_to < level_from - in_level || other.level_from > level_to + in_level);
}

void CurveIndex::Range::add(const Range& other) {
  period_from = std::fmin(period_from, other.period_from);
  period_to = std::fmax(period_to, other.period_to);
  level_from = std::fmin(level_from, other.level_from);
  level_to = std::fmax(level_to, other.level_to);
}

CurveIndex::CurveIndex(const AtlasTree& tree) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t family = 0; family < tree.families.size(); ++family) {
    const std::vector<Invariants>& points = tree.families[family].curve.points();
    Extent& extent = _extents.emplace_back(_entries.size(), 0, Range{none, none, none, none});
    for (const Invariants& point : points) {
      const double period = point.value(Invariant::period);
      const double level = point.value(Invariant::level);
      extent.range.add({period, period, level, level});
      extent.in_period = std::fmax(extent.in_period, point.floor_of(Invariant::period));
      extent.in_level = std::fmax(extent.in_level, point.floor_of(Invariant::level));
    }
    for (std::size_t n = 0; n + 1 < points.size(); ++n) {
      auto [period_from, period_to] = range_beyond(points, n, Invariant::period);
      const auto [level_from, level_to] = range_beyond(points, n, Invariant::level);
      const double shortest = std::fmin(points[n].value(Invariant::period), points[n + 1].value(Invariant::period));
      if (!(shortest > 0.0) || !std::isfinite(period_to)) continue;
      period_from = std::fmax(period_from, beyond_segment * shortest);  // a step may be longer than the period
      for (std::int64_t cell = cell_of(period_from); cell <= cell_of(period_to); ++cell)
        _cells[cell].push_back(_entries.size());
      _entries.push_back({{static_cast<int>(family), n}, {period_from, period_to, level_from, level_to}});
      extent.range.add(_entries.back().range);
    }
    extent.end = _entries.size();
  }
}

std::vector<CurveIndex::Segment> CurveIndex::near(double period, double level, double in_period,
                                                  double in_level) const {
  std::vector<std::size_t> found;
  for (std::int64_t cell = cell_of(period - in_period); cell <= cell_of(period + in_period); ++cell) {
    const auto entries = _cells.find(cell);
    if (entries == _cells.end()) continue;
    for (const std::size_t n : entries->second)
      if (_entries[n].range.overlaps({period, period, level, level}, in_period, in_level)) found.push_back(n);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Segment> segments;
  segments.reserve(found.size());
  for (const std::size_t n : found) segments.push_back(_entries[n].at);
  return segments;
}

std::vector<CurveIndex::Segment> CurveIndex::near_on(int family, double period, double level, double in_period,
                                                     double in_level) const {
  const Extent& extent = _extents[static_cast<std::size_t>(family)];
  std::vector<Segment> segments;
  for (std::size_t n = extent.begin; n < extent.end; ++n)
    if (_entries[n].range.overlaps({period, period, level, level}, in_period, in_level))
      segments.push_back(_entries[n].at);
  return segments;
}

bool CurveIndex::may_meet(int family, int other, double floors) const {
  const Extent& a = _extents[static_cast<std::size_t>(family)];
  const Extent& b = _extents[static_cast<std::size_t>(other)];
  return a.range.overlaps(b.range, floors * std::fmax(a.in_period, b.in_period),
                          floors * std::fmax(a.in_level, b.in_level));
}

}  // namespace orbweaver::survey
