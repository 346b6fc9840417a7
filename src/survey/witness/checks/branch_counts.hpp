#pragma once

#include <algorithm>

#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "tasks/payload/task_kind.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// At each branch point: as many directions as its kernel has were found, and each has been left or arrived along.
class BranchCounts final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    for (const CrossingEvidence& crossing : evidence.known.tree.crossings) judge(evidence, crossing, found);
    return found;
  }

 private:
  /// Lines modulo the crossing's symmetries in a kernel of one sector (docs/mathematics.md, "Kernels and directions").
  /// 0: one pair of multipliers does not tell, and any number but none will do.
  static int expected_directions(const Evidence& evidence, const CrossingEvidence& crossing) {
    const int of_one_pair = crossing.q <= 2 ? 1 : 2;
    const bool is_unknown = crossing.kernel_dimension < 0;  // too many harmonics
    if (crossing.kernel_dimension != of_one_pair && !is_unknown) return 0;
    if (crossing.q <= 2) return 1;
    const int mirrors = pointwise_symmetries(evidence, evidence.crossing(crossing.crossing).family);
    if (mirrors > 0 && (mirrors > 1 || evidence.system->structure().pairs() > 1)) return 0;
    return crossing.q % 2 != 0 && mirrors == 0 ? 1 : 2;
  }

  /// Where a pair of multipliers is -1 twice over, what decides the directions is an even function on the kernel's
  /// circle: it has a line of maxima and one of minima.
  static int least_directions(const Evidence& evidence, const CrossingEvidence& crossing) {
    const bool is_pair = crossing.q == 2 && crossing.kernel_dimension == 2;
    return is_pair && evidence.system->structure().conservative() ? 2 : 0;
  }

  /// Symmetries that keep every point of the family's orbits. A single one turns the plane transverse to the orbit by
  /// half a turn, and with it the kernel.
  static int pointwise_symmetries(const Evidence& evidence, int row) {
    const systems::Structure& structure = evidence.system->structure();
    const loop::SymmetryGroup group(structure, loop::isotropy_of(structure, evidence.family(row).isotropy));
    const auto keeps = [](const loop::SymmetryElement& e) { return !e.reversing && e.shift_numerator == 0; };
    const auto kept = std::count_if(group.elements().begin(), group.elements().end(), keeps);
    return static_cast<int>(kept) - 1;  // the identity
  }

  static void judge(const Evidence& evidence, const CrossingEvidence& crossing, std::vector<Finding>& found) {
    const TreeCrossing& place = evidence.crossing(crossing.crossing);
    Finding finding;
    finding.family = place.family;
    finding.crossing = crossing.crossing;
    finding.period = place.period;
    finding.level = place.level;
    const auto add = [&](FindingKind kind, Severity severity) {
      finding.kind = kind;
      finding.severity = severity;
      found.push_back(finding);
    };
    if (crossing.failed) return;  // said already
    if ((crossing.limited_by & period_limited) != 0) return add(FindingKind::beyond_period, Severity::cut);
    if ((crossing.limited_by & order_limited) != 0) return add(FindingKind::beyond_order, Severity::cut);
    if (crossing.kernel_dimension <= 0 && !crossing.undecided) return;
    if ((crossing.limited_by & depth_limited) != 0) return add(FindingKind::beyond_depth, Severity::cut);
    const int least = least_directions(evidence, crossing);
    const int expected = std::max(expected_directions(evidence, crossing), crossing.directions < least ? least : 0);
    finding.number = crossing.directions;
    finding.other_number = expected;
    finding.deviation = expected - crossing.directions;
    const bool is_open = crossing.undecided || expected == least;
    if (expected > 0 && crossing.directions != expected)
      add(FindingKind::missing_directions, is_open ? Severity::undecided : Severity::contradiction);
    else if (crossing.directions == 0 || crossing.undecided)
      add(FindingKind::missing_directions, Severity::undecided);
    finding.deviation = archive::not_computed;
    for (std::size_t n = 0; n < crossing.sides.size(); ++n) {
      finding.number = static_cast<int>(n);
      switch (crossing.sides[n]) {
        case DirectionFate::beyond_limits: add(FindingKind::beyond_limits, Severity::cut); break;
        case DirectionFate::beyond_families: add(FindingKind::beyond_families, Severity::cut); break;
        case DirectionFate::hidden: add(FindingKind::unfollowed_direction, Severity::undecided); break;
        case DirectionFate::unknown:
          add(FindingKind::unfollowed_direction,
              evidence.known.stopped_early ? Severity::cut : Severity::contradiction);
          break;
        case DirectionFate::followed:
        case DirectionFate::arrived:
        case DirectionFate::failed: break;  // failures are said already
      }
    }
  }
};

}  // namespace orbweaver::survey
