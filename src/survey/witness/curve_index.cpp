#include "curve_index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace orbweaver::survey {

namespace {

/// Cells in a factor e of the period: steps change T by a percent or so, which is a few cells.
constexpr double cells_per_factor = 512.0;

std::int64_t cell_of(double period) {
  return static_cast<std::int64_t>(std::floor(cells_per_factor * std::log(period)));
}

/// Of a step, beyond the orbits of a segment: as far as a parabola through three orbits goes beyond two of them.
constexpr double beyond = 0.5;

}  // namespace

std::pair<double, double> range_beyond(const std::vector<Invariants>& points, std::size_t segment, Invariant i) {
  double longest = 0.0;
  for (std::size_t n = segment > 0 ? segment - 1 : 0; n + 1 < points.size() && n <= segment + 1; ++n)
    longest = std::fmax(longest, std::abs(points[n + 1].value(i) - points[n].value(i)));
  const auto [from, to] = std::minmax({points[segment].value(i), points[segment + 1].value(i)});
  return {from - beyond * longest, to + beyond * longest};
}

CurveIndex::CurveIndex(const AtlasTree& tree) {
  for (std::size_t family = 0; family < tree.families.size(); ++family) {
    const std::vector<Invariants>& points = tree.families[family].curve.points();
    for (std::size_t n = 0; n + 1 < points.size(); ++n) {
      auto [period_from, period_to] = range_beyond(points, n, Invariant::period);
      const auto [level_from, level_to] = range_beyond(points, n, Invariant::level);
      const double shortest = std::fmin(points[n].value(Invariant::period), points[n + 1].value(Invariant::period));
      if (!(shortest > 0.0) || !std::isfinite(period_to)) continue;
      period_from = std::fmax(period_from, beyond * shortest);  // a step may be longer than the period
      for (std::int64_t cell = cell_of(period_from); cell <= cell_of(period_to); ++cell)
        _cells[cell].push_back(_entries.size());
      _entries.push_back({{static_cast<int>(family), n}, period_from, period_to, level_from, level_to});
    }
  }
}

std::vector<CurveIndex::Segment> CurveIndex::near(double period, double level, double in_period,
                                                  double in_level) const {
  std::vector<std::size_t> found;
  for (std::int64_t cell = cell_of(period - in_period); cell <= cell_of(period + in_period); ++cell) {
    const auto entries = _cells.find(cell);
    if (entries == _cells.end()) continue;
    for (const std::size_t n : entries->second) {
      const Entry& e = _entries[n];
      const bool is_outside = period < e.period_from - in_period || period > e.period_to + in_period ||
                              level < e.level_from - in_level || level > e.level_to + in_level;
      if (!is_outside) found.push_back(n);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Segment> segments;
  segments.reserve(found.size());
  for (const std::size_t n : found) segments.push_back(_entries[n].at);
  return segments;
}

}  // namespace orbweaver::survey
