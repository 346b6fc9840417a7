#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/survey/tree/naming.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Where another curve of equilibria passes through one that was followed, some other curve of the archive must have
/// the same point: else its equilibria, and the families that begin at them, are missing.
class EquilibriumBranches final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    const archive::Table& table = evidence.tree.atlas.equilibria();
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (table.texts("kind")[row] != "branch-point" || is_shared(evidence, table, row)) continue;
      Finding finding;
      finding.kind = FindingKind::unknown_branch;
      finding.severity = Severity::undecided;
      finding.level = table.reals("parameter")[row];
      finding.detail =
          fmt::format("{} at {} = {:.9g}", equilibrium_name(static_cast<int>(table.integers("equilibrium")[row])),
                      evidence.system->family_scalars().free.front(), finding.level);
      found.push_back(finding);
    }
    return found;
  }

 private:
  /// Whether a curve of another equilibrium, or the same curve elsewhere, has a branch point there.
  static bool is_shared(const Evidence& evidence, const archive::Table& table, std::size_t row) {
    const std::vector<double> here = place(evidence, table, row);
    double size = 1.0;
    for (const double x : here) size = std::max(size, std::abs(x));
    for (std::size_t other = 0; other < table.rows(); ++other) {
      if (other == row || table.texts("kind")[other] != "branch-point") continue;
      if (evidence.distance_between(here, place(evidence, table, other)) <= same_place * size) return true;
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

  /// Relative. Two curves that touch are located there to the root of their rounding.
  static constexpr double same_place = 1e-6;
};

}  // namespace orbweaver::survey
