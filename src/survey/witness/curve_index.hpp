#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "orbweaver/survey/atlas/atlas_tree.hpp"

namespace orbweaver::survey {

/// Of a step, beyond the orbits of a segment: as far as a parabola through three orbits goes beyond two of them.
constexpr double beyond_segment = 0.5;

/// The range of an invariant between two neighbouring orbits and half a step beyond, the longest of theirs and those
/// beside it: a family may turn between two orbits.
[[nodiscard]] std::pair<double, double> range_beyond(const std::vector<Invariants>& points, std::size_t segment,
                                                     Invariant invariant);

/// The segments between neighbouring orbits of all families of an atlas, found by period and level.
class CurveIndex {
 public:
  struct Segment {
    int family = -1;
    std::size_t segment = 0;  ///< between its orbits segment and segment + 1
  };

  explicit CurveIndex(const AtlasTree& tree);

  /// Those whose ranges of period and level, widened by `in_period` and `in_level` (absolute), hold the place; by
  /// family, then segment. A NaN level lies in all ranges. Ranges are those of range_beyond.
  [[nodiscard]] std::vector<Segment> near(double period, double level, double in_period, double in_level) const;
  /// Those of one family.
  [[nodiscard]] std::vector<Segment> near_on(int family, double period, double level, double in_period,
                                             double in_level) const;
  /// Whether the ranges of two whole families overlap, widened by `floors` of their invariants' largest floors.
  [[nodiscard]] bool may_meet(int family, int other, double floors) const;

 private:
  struct Range {
    double period_from, period_to, level_from, level_to;

    [[nodiscard]] bool overlaps(const Range& other, double in_period, double in_level) const;
    void add(const Range& other);
  };
  struct Entry {
    Segment at;
    Range range;
  };
  /// Of a family: its entries, and the ranges of these and of its orbits together.
  struct Extent {
    std::size_t begin = 0;
    std::size_t end = 0;
    Range range;
    double in_period = 0.0;
    double in_level = 0.0;
  };
  std::vector<Entry> _entries;                                        // by family, then segment
  std::vector<Extent> _extents;                                       // by family
  std::unordered_map<std::int64_t, std::vector<std::size_t>> _cells;  // of the logarithm of the period
};

}  // namespace orbweaver::survey
