#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "tasks/payload/task_kind.hpp"
#include "witness/check.hpp"
#include "witness/passing.hpp"

namespace orbweaver::survey {

/// Every end is a limit of the scene, an end by itself, or a crossing of another family that is known.
class Ends final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    for (const EndEvidence& end : evidence.known.tree.ends)
      if (std::optional<Finding> finding = judged(evidence, end)) found.push_back(*finding);
    return found;
  }

 private:
  /// Times around that are looked for: as loop::repetitions.
  static constexpr int most_times = 100;

  static bool is_limit(continuation::EndReason reason) {
    using continuation::EndReason;
    switch (reason) {
      case EndReason::period_limit:
      case EndReason::energy_limit:
      case EndReason::step_limit:
      case EndReason::cutoff_limit:
      case EndReason::parameter_limit:
      case EndReason::guard_limit:
      case EndReason::stopped: return true;
      case EndReason::collision:
      case EndReason::period_divergence:
      case EndReason::fixed_point:
      case EndReason::closed_loop:
      case EndReason::strong_resonance:
      case EndReason::more_symmetry:
      case EndReason::undecided:
      case EndReason::failure: break;
    }
    return false;
  }

  static std::optional<Finding> judged(const Evidence& evidence, const EndEvidence& end) {
    Finding finding;
    finding.family = evidence.row_of(end.family);
    const TreeFamily& family = evidence.family(finding.family);
    if (end.failed || !end.end) return std::nullopt;  // said as a failure
    if (end.met) {
      finding.period = end.period;
      finding.level = end.level;
      if (end.joined && end.crossing >= 0) return come_back(evidence, end, finding);
      if (end.joined) {
        finding.kind = FindingKind::unlisted_target;
        finding.severity = Severity::contradiction;
        return finding;
      }
      return end.nearby.empty() ? met_somewhere(evidence, family, end, finding) : met_crossing(evidence, end, finding);
    }
    if (end.end->reason == continuation::EndReason::fixed_point) return at_equilibrium(evidence, family, end, finding);
    if (end.end->reason == continuation::EndReason::undecided) {
      finding.kind = FindingKind::undecided_end;
      finding.severity = Severity::undecided;
      finding.detail = end.end->detail;
      return finding;
    }
    if (!is_limit(end.end->reason)) return std::nullopt;
    finding.kind = FindingKind::limited_end;
    finding.severity = Severity::cut;
    finding.detail = end.end->text();
    return finding;
  }

  // A closed curve through the crossing where it begins takes two directions there, and one side of a direction has one
  // family: where more leave and arrive than there are sides, the branch has gone over to another one on the way.
  static std::optional<Finding> come_back(const Evidence& evidence, const EndEvidence& end, Finding finding) {
    if (evidence.family(finding.family).crossing != end.crossing) return std::nullopt;
    int sides = 0;
    for (const CrossingEvidence& crossing : evidence.known.tree.crossings)
      if (crossing.crossing == end.crossing && !crossing.undecided) sides = static_cast<int>(crossing.sides.size());
    int families = 0;
    for (const EndEvidence& other : evidence.known.tree.ends) {
      const int row = evidence.row_of(other.family);
      if (row < 0) continue;
      if (evidence.family(row).crossing == end.crossing) ++families;
      if (other.joined && other.crossing == end.crossing) ++families;
    }
    if (sides == 0 || families <= sides) return std::nullopt;
    finding.kind = FindingKind::taken_direction;
    finding.severity = Severity::contradiction;
    finding.crossing = end.crossing;
    finding.number = families;
    finding.other_number = sides;
    return finding;
  }

  // A family of small oscillations there is the same curve, which the check for curves stored twice sees.
  static std::optional<Finding> at_equilibrium(const Evidence& evidence, const TreeFamily& family,
                                               const EndEvidence& end, Finding finding) {
    if (family.orbits() == 0) return std::nullopt;
    const std::size_t orbit = end.side > 0 ? family.orbits() - 1 : 0;
    const std::size_t row = family.first_orbit + orbit;
    const std::vector<double> modes = evidence.tree.atlas.modes(row);
    const auto dimension = static_cast<std::size_t>(evidence.system->structure().dimension);
    double size = 0.0;  // no point of the loop is further from the mean
    for (std::size_t n = dimension; n < modes.size(); ++n) size += std::abs(modes[n]);
    const std::span<const double> mean(modes.data(), dimension);
    for (const std::vector<double>& point : evidence.known.equilibria)
      if (evidence.distance_between(mean, point) <= size) return std::nullopt;
    const Invariants& last = family.curve.points()[orbit];
    if (is_hopf_point(evidence, family, mean, size, last.value(Invariant::level))) return std::nullopt;
    finding.kind = FindingKind::unknown_equilibrium;
    finding.severity = Severity::undecided;
    finding.period = last.value(Invariant::period);
    finding.level = last.value(Invariant::level);
    return finding;
  }

  // A family that shrinks to a Hopf point has nearly its parameter there: they differ by the square of its size.
  static bool is_hopf_point(const Evidence& evidence, const TreeFamily& family, std::span<const double> mean,
                            double size, double level) {
    double least = level;
    double greatest = level;
    for (const Invariants& point : family.curve.points()) {
      least = std::fmin(least, point.value(Invariant::level));
      greatest = std::fmax(greatest, point.value(Invariant::level));
    }
    for (const auto& [key, hopf] : evidence.known.beginnings)  // the state, then the parameter
      if (evidence.distance_between(mean, hopf) <= size && std::abs(hopf.back() - level) <= 0.01 * (greatest - least))
        return true;
    return false;
  }

  // Near crossings that were found: a limit kept their directions from being looked for, or theirs are others.
  static Finding met_crossing(const Evidence& evidence, const EndEvidence& end, Finding finding) {
    finding.crossing = end.nearby.front();
    finding.kind = FindingKind::unknown_direction;
    finding.severity = end.is_short ? Severity::undecided : Severity::contradiction;
    for (const int nearby : end.nearby) {
      const TreeCrossing& place = evidence.crossing(nearby);
      if (place.multiplicity <= evidence.scene.survey.subharmonics) continue;
      finding.crossing = -1;  // beneath the end of another branch: no directions were looked for
      finding.kind = FindingKind::higher_order;
      finding.severity = Severity::cut;
      finding.other_family = place.family;
      finding.number = place.multiplicity;
      return finding;
    }
    for (const int nearby : end.nearby)
      for (const CrossingEvidence& crossing : evidence.known.tree.crossings) {
        if (crossing.crossing != nearby) continue;
        if ((crossing.limited_by & (depth_limited | period_limited)) != 0) {
          finding.crossing = nearby;
          finding.kind =
              (crossing.limited_by & depth_limited) != 0 ? FindingKind::beyond_depth : FindingKind::beyond_period;
          finding.severity = Severity::cut;
        } else if ((crossing.failed || crossing.undecided) && finding.severity == Severity::contradiction) {
          finding.crossing = nearby;
          finding.severity = Severity::undecided;
        }
      }
    finding.other_family = evidence.crossing(finding.crossing).family;
    return finding;
  }

  // Symmetries of a family's orbits: what is met has more of them, or is gone around more than once.
  static std::size_t order_of(const Evidence& evidence, const TreeFamily& family) {
    const systems::Structure& structure = evidence.system->structure();
    return loop::SymmetryGroup(structure, loop::isotropy_of(structure, family.isotropy)).elements().size();
  }

  // Where no crossing is known: a family that passes there, gone around some times.
  static Finding met_somewhere(const Evidence& evidence, const TreeFamily& family, const EndEvidence& end,
                               Finding finding) {
    finding.kind = FindingKind::unknown_family;
    finding.severity = Severity::undecided;
    if (family.orbits() == 0) return finding;
    const Invariants& last = end.side > 0 ? family.curve.points().back() : family.curve.points().front();
    const double action = last.value(Invariant::action) + 0.5 * (last.value(Invariant::period) + end.period) *
                                                              (end.level - last.value(Invariant::level));
    for (int m = 1; m <= most_times; ++m) {
      const double period = end.period / m;
      int met = -1;  // of several that are images, the one at the same equilibrium
      for (const auto& [other, segment] :
           passing(evidence.tree, evidence.index, {period, end.level, action / m, last.scale_of(Invariant::level)})) {
        if (m == 1 && order_of(evidence, evidence.family(other)) <= order_of(evidence, family)) continue;
        if (met < 0 || evidence.equilibrium_of(other) == evidence.equilibrium_of(finding.family)) met = other;
      }
      if (met < 0) continue;
      finding.other_family = met;
      finding.number = m;
      const bool is_higher = m > evidence.scene.survey.subharmonics;
      finding.kind = is_higher ? FindingKind::higher_order : FindingKind::unlisted_crossing;
      finding.severity = is_higher ? Severity::cut : Severity::undecided;
      return finding;
    }
    if (is_beyond_limits(evidence.scene.limits, evidence.tree.in_parameter(), end.level))
      finding.severity = Severity::cut;
    return finding;
  }

  // What is met there has been cut before it.
  static bool is_beyond_limits(const scene::Limits& limits, bool in_parameter, double level) {
    return in_parameter ? level < limits.parameter_from || level > limits.parameter_to
                        : level < limits.energy_from || level > limits.energy_to;
  }
};

}  // namespace orbweaver::survey
