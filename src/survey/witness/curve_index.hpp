#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "orbweaver/survey/atlas/atlas_tree.hpp"

namespace orbweaver::survey {

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

 private:
  struct Entry {
    Segment at;
    double period_from, period_to, level_from, level_to;
  };
  std::vector<Entry> _entries;                                        // by family, then segment
  std::unordered_map<std::int64_t, std::vector<std::size_t>> _cells;  // of the logarithm of the period
};

}  // namespace orbweaver::survey
