#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/survey/tree/naming.hpp"
#include "tasks/equilibrium_places.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Where another curve of equilibria passes through one that was followed, some other curve of the archive must have
/// the same point: else its equilibria, and the families that begin at them, are missing. Where that is not told, or
/// whether eigenvalues pass the axis, or the curve is left for its length, its note says so.
class EquilibriumBranches final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    const archive::Table& table = evidence.tree.atlas.equilibria();
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::string& note = table.texts("note")[row];
      if (note.starts_with(undecided_note)) {
        Finding finding = finding_at(evidence, table, row, FindingKind::undecided_event);
        finding.detail += ": not told on the curve of equilibria: " + note.substr(undecided_note.size());
        found.push_back(std::move(finding));
      }
      if (table.texts("kind")[row] == "branch-point" && !is_shared(evidence, table, row))
        found.push_back(finding_at(evidence, table, row, FindingKind::unknown_branch));
    }
    return found;
  }

 private:
  static Finding finding_at(const Evidence& evidence, const archive::Table& table, std::size_t row, FindingKind kind) {
    Finding finding;
    finding.kind = kind;
    finding.severity = Severity::undecided;
    finding.level = table.reals("parameter")[row];
    finding.detail =
        fmt::format("{} at {} = {:.9g}", equilibrium_name(static_cast<int>(table.integers("equilibrium")[row])),
                    evidence.system->family_scalars().free.front(), finding.level);
    return finding;
  }

  /// Whether a curve of another equilibrium, or the same curve elsewhere, has a branch point there.
  static bool is_shared(const Evidence& evidence, const archive::Table& table, std::size_t row) {
    const std::vector<double> here = place(evidence, table, row);
    double size = 1.0;
    for (const double x : here) size = std::max(size, std::abs(x));
    const double bound = same_place * std::sqrt(size);
    for (std::size_t other = 0; other < table.rows(); ++other) {
      if (other == row || table.texts("kind")[other] != "branch-point") continue;
      if (table.integers("equilibrium")[other] == table.integers("equilibrium")[row] &&
          std::abs(table.reals("arclength")[other] - table.reals("arclength")[row]) <= elsewhere * bound)
        continue;
      if (evidence.distance_between(here, place(evidence, table, other)) <= bound) return true;
    }
    return false;
  }

  /// The state, then the parameter, in scales.
  static std::vector<double> place(const Evidence& evidence, const archive::Table& table, std::size_t row) {
    const systems::Scales& scales = evidence.system->scales();
    const auto dimension = scales.coordinates.size();
    std::vector<double> out;
    for (std::size_t i = 0; i < dimension; ++i)
      out.push_back(table.reals("state")[row * dimension + i] / scales.coordinates[i]);
    const std::string& name = evidence.system->family_scalars().free.front();
    out.push_back(table.reals("parameter")[row] / evidence.system->parameter_scale(name));
    return out;
  }

  /// Two curves that touch are located there to the root of their rounding, which is relative to their coordinates.
  static constexpr double same_place = 1e-6;
  /// Of that distance: points of one curve that are no further apart along it are neighbours.
  static constexpr double elsewhere = 100.0;
};

}  // namespace orbweaver::survey
