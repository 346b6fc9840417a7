#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "witness/check.hpp"
#include "witness/stored_stability.hpp"

namespace orbweaver::survey {

/// Between two orbits of a family, its birth and the first of them, or the last and the family that it joins, a
/// multiplier passes a root of unity that the scene asks for only where a crossing is listed. Of a family with an index
/// that double precision does not tell this is said, once.
class IndexChanges final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    if (archive::stability_width(evidence.tree.atlas.header()) == 0) return found;
    for (std::size_t row = 0; row < evidence.tree.families.size(); ++row) {
      const TreeFamily& family = evidence.tree.families[row];
      Signs last;
      for (const auto& [first, count] : sides_of(evidence, family)) {
        if (family.crossing >= 0) last.clear();  // its birth lies between the sides; else an orbit that is given
        judge(evidence, static_cast<int>(row), first, count, last, found);
      }
      judge_birth(evidence, static_cast<int>(row), found);
    }
    return found;
  }

 private:
  struct Signed {
    std::size_t orbit;
    int sign;
  };

  using Signs = std::vector<std::optional<Signed>>;  // of each function, the last that rounding tells

  // Ranges of a family's orbits: those before the crossing where it was born, and those behind it.
  static std::vector<std::pair<std::size_t, std::size_t>> sides_of(const Evidence& evidence, const TreeFamily& family) {
    const auto& steps = evidence.tree.atlas.orbits().integers("step");
    std::size_t before = 0;
    while (before < family.orbits() && steps[family.first_orbit + before] < 0) ++before;
    return {{0, before}, {before, family.orbits() - before}};
  }

  static void judge(const Evidence& evidence, int row, std::size_t first, std::size_t count, Signs& last,
                    std::vector<Finding>& found) {
    if (count == 0) return;
    const TreeFamily& family = evidence.family(row);
    const systems::Structure& structure = evidence.system->structure();
    const int order = fundamental_order_of(evidence, family);
    const auto functions = bifurcation::test_functions(structure, order, evidence.scene.survey.subharmonics);
    last.resize(functions.size());
    const Side side = side_of(evidence, family, first, count);
    if (const std::optional<Finding> undecided = undecided_at(evidence, row, first, count, order))
      found.push_back(*undecided);
    for (std::size_t n = first; n < first + count; ++n) {
      const spectrum::Stability stability = stored_stability(evidence, family.first_orbit + n, order);
      if (!bifurcation::are_decided(stability)) {  // what is passed here is not known
        std::fill(last.begin(), last.end(), std::nullopt);
        continue;
      }
      for (std::size_t f = 0; f < functions.size(); ++f) {
        if (!bifurcation::has_sector(functions[f].kind)) continue;
        const bifurcation::Reading reading = bifurcation::evaluate(functions[f], structure, stability);
        // The index leaves 2 at a birth like a power of the distance, first within its error.
        const bool is_birth = family.parent >= 0 && functions[f].sector.q == 1 && n == side.nearest;
        const int sign = is_birth && std::abs(reading.value) <= bifurcation::zero_at_birth ? 0 : reading.sign();
        if (sign == 0) continue;
        const std::optional<Signed> before = std::exchange(last[f], Signed{n, sign});
        if (!before || before->sign == sign) continue;
        if (!is_listed(evidence, family, functions[f].sector, family.arclengths[before->orbit], family.arclengths[n]))
          found.push_back(finding_at(evidence, row, functions[f].sector, n, stability, evidence.severity_about(row)));
      }
    }
    if (!structure.symplectic || evidence.tree.atlas.header().pairs != 1) return;
    judge_ends(evidence, row, side, functions, order, found);
  }

  /// The orbits of a side next to its birth and next to its end, and the arclengths between which there is nothing but
  /// the way from the birth.
  struct Side {
    std::size_t nearest;
    std::size_t farthest;
    double from;
    double to;
  };

  static Side side_of(const Evidence& evidence, const TreeFamily& family, std::size_t first, std::size_t count) {
    constexpr double far = std::numeric_limits<double>::infinity();
    const auto& steps = evidence.tree.atlas.orbits().integers("step");
    const std::size_t last = first + count - 1;
    const double birth = family.birth_arclength;
    if (steps[family.first_orbit + first] < 0)
      return {last, first, family.arclengths[last], std::isnan(birth) ? far : birth};
    return {first, last, std::isnan(birth) ? -far : birth, family.arclengths[first]};
  }

  /// Where a family is born, and where it joins another, its index is 2: the orbits next to these places have it on
  /// the same side of all other values, or there are crossings in between. Those before a joining lie where orbits
  /// cannot be told from the other family's.
  static void judge_ends(const Evidence& evidence, int row, const Side& side,
                         const std::vector<bifurcation::TestFunction>& functions, int order,
                         std::vector<Finding>& found) {
    const TreeFamily& family = evidence.family(row);
    const systems::Structure& structure = evidence.system->structure();
    const bool has_joined = std::any_of(family.ends.begin(), family.ends.end(), [&](const FamilyEnd& end) {
      return end.kind == EndKind::joined && end.orbit == side.farthest;
    });
    for (const bool is_birth : {true, false}) {
      if (is_birth ? family.parent < 0 : !has_joined) continue;
      const std::size_t orbit = is_birth ? side.nearest : side.farthest;
      const spectrum::Stability stability = stored_stability(evidence, family.first_orbit + orbit, order);
      if (!bifurcation::are_decided(stability)) continue;
      for (const bifurcation::TestFunction& function : functions) {
        if (!bifurcation::has_sector(function.kind) || function.sector.q == 1) continue;
        if (bifurcation::evaluate(function, structure, stability).sign() >= 0) continue;
        if (is_birth && is_listed(evidence, family, function.sector, side.from, side.to)) continue;
        found.push_back(finding_at(evidence, row, function.sector, orbit, stability,
                                   is_birth ? evidence.severity_about(row) : Severity::undecided));
      }
    }
  }

  /// Where a family goes through a crossing of order 3, k - 2 goes to zero there like the square of the way. If it has
  /// two signs at the nearest orbits on both sides, the energy turns between them, however near to the crossing.
  static void judge_birth(const Evidence& evidence, int row, std::vector<Finding>& found) {
    const TreeFamily& family = evidence.family(row);
    const systems::Structure& structure = evidence.system->structure();
    const auto sides = sides_of(evidence, family);
    const std::size_t begin = sides[1].first;
    if (!structure.symplectic || evidence.tree.atlas.header().pairs != 1 || family.crossing < 0) return;
    if (sides[0].second == 0 || sides[1].second == 0 || evidence.crossing(family.crossing).sector_q != 3) return;
    const int order = fundamental_order_of(evidence, family);
    const bifurcation::Sector one{1, 0};
    // The nearest whose sign is known.
    std::size_t before = begin - 1;
    std::size_t behind = begin;
    while (before > 0 && stored_side_of_one(evidence, family, before) == 0) --before;
    while (behind + 1 < family.orbits() && stored_side_of_one(evidence, family, behind) == 0) ++behind;
    const int product = stored_side_of_one(evidence, family, before) * stored_side_of_one(evidence, family, behind);
    if (product >= 0 || is_listed(evidence, family, one, family.arclengths[before], family.arclengths[behind])) return;
    const spectrum::Stability stability = stored_stability(evidence, family.first_orbit + behind, order);
    found.push_back(finding_at(evidence, row, one, behind, stability, Severity::undecided));
    Finding& finding = found.back();
    finding.kind = FindingKind::undecided_event;
    finding.detail =
        "its energy turns between its first orbits on both sides of its birth, as an index that passes 2 tells, nearer "
        "to it than is resolved";
  }

  // Where rounding hides what an index passes, the branch has looked for nothing. Where it is known worst.
  static std::optional<Finding> undecided_at(const Evidence& evidence, int row, std::size_t first, std::size_t count,
                                             int order) {
    std::optional<Finding> worst;
    for (std::size_t n = first; n < first + count; ++n) {
      spectrum::Stability stability = stored_stability(evidence, evidence.family(row).first_orbit + n, order);
      double& error = stability.fundamental_error.front();
      error /= bifurcation::error_margin;
      if (bifurcation::are_decided(stability) || (worst && worst->deviation >= error)) continue;
      worst = finding_at(evidence, row, {}, n, stability, Severity::undecided);
      worst->kind = FindingKind::undecided_indices;
      worst->deviation = error;
    }
    return worst;
  }

  static bool is_listed(const Evidence& evidence, const TreeFamily& family, const bifurcation::Sector& sector,
                        double begin, double end) {
    const auto& arclengths = evidence.tree.atlas.crossings().reals("arclength");
    return std::any_of(family.crossings.begin(), family.crossings.end(), [&](int row) {
      const TreeCrossing& crossing = evidence.crossing(row);
      const double at = arclengths[static_cast<std::size_t>(row)];
      const bool is_fold = archive::crossing_kind_of(crossing.kind) == archive::CrossingKind::fold_energy;
      const bool fits = is_fold ? sector.q == 1 : crossing.sector_q == sector.q && crossing.sector_j == sector.j;
      const double margin = bifurcation::error_margin * crossing.place_error;
      return fits && at >= begin - margin && at <= end + margin;
    });
  }

  static Finding finding_at(const Evidence& evidence, int row, const bifurcation::Sector& sector, std::size_t orbit,
                            const spectrum::Stability& stability, Severity severity) {
    const Invariants& x = evidence.family(row).curve.points()[orbit];
    Finding finding;
    finding.kind = FindingKind::index_change;
    finding.severity = severity;
    finding.family = row;
    finding.period = x.value(Invariant::period);
    finding.level = x.value(Invariant::level);
    finding.number = sector.j;
    finding.other_number = sector.q;
    finding.deviation = stability.fundamental.front().real() - sector.value(evidence.system->structure().symplectic);
    return finding;
  }
};

}  // namespace orbweaver::survey
