#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "orbweaver/archive/schema/schema.hpp"
#include "tasks/payload/keys.hpp"
#include "tasks/payload/sweep_work.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Where several oscillations of an equilibrium share a period and their energy has one sign, the indices of the
/// families that leave add up to the number of oscillations (docs/mathematics.md, "What adds up"), told from the
/// stability of their first orbits.
class EquilibriumFamilies final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    for (std::size_t n = 0; n < evidence.known.kernels.size(); ++n)
      for (const KernelRecord& kernel : evidence.known.kernels[n])
        if (kernel.not_isolated > 0) found.push_back(continuum_at(evidence, n, kernel));
    const archive::Header& header = evidence.tree.atlas.header();
    if (archive::stability_width(header) == 0 || archive::has_complex_stability(header)) return found;
    for (std::size_t n = 0; n < evidence.known.kernels.size(); ++n)
      for (const KernelRecord& kernel : evidence.known.kernels[n])
        // Pairs of multipliers that do not come from the kernel have signs of their own.
        if (kernel.is_definite && kernel.dimension == header.pairs + 1) judge(evidence, n, kernel, found);
    return found;
  }

 private:
  static Finding continuum_at(const Evidence& evidence, std::size_t equilibrium, const KernelRecord& kernel) {
    Finding finding;
    finding.kind = FindingKind::continuum;
    finding.severity = Severity::undecided;
    finding.period = kernel.period * evidence.known.time_unit;
    finding.number = kernel.not_isolated;
    for (const int place : kernel.places)
      for (const int row : rows_of(evidence, equilibrium, place))
        if (finding.family < 0) finding.family = row;
    return finding;
  }

  /// Rows of the family, or of its two sides.
  static std::vector<int> rows_of(const Evidence& evidence, std::size_t equilibrium, int place) {
    const std::string key = base_key(static_cast<int>(equilibrium), place);
    std::vector<int> rows;
    for (const char* side : {"", "+", "-"})
      if (const int row = evidence.row_of(key + side); row >= 0) rows.push_back(row);
    return rows;
  }

  /// Of the family's first orbits, up to its first crossing: that which rounding tells first.
  static std::optional<int> index_of(const Evidence& evidence, int row, int repetitions) {
    const TreeFamily& family = evidence.family(row);
    const auto& steps = evidence.tree.atlas.orbits().integers("step");
    double until = std::numeric_limits<double>::infinity();
    for (const int crossing : family.crossings)
      until = std::min(until, evidence.tree.atlas.crossings().reals("arclength")[static_cast<std::size_t>(crossing)]);
    for (std::size_t n = 0; n < family.orbits(); ++n) {
      if (steps[family.first_orbit + n] < 0) continue;
      if (family.arclengths[n] >= until) break;
      if (const auto index = index_of_orbit(evidence, family.first_orbit + n, repetitions)) return index;
    }
    return std::nullopt;
  }

  /// The index of an orbit among all orbits of its energy modulo time shifts: of a vector field on the quotient by the
  /// group of the `repetitions`, with as many signs as elements.
  static std::optional<int> index_of_orbit(const Evidence& evidence, std::size_t orbit, int repetitions) {
    const archive::Archive& atlas = evidence.tree.atlas;
    const std::size_t pairs = archive::stability_width(atlas.header());
    const double error = error_margin * atlas.orbits().reals("stability_error")[orbit];
    int sum = 0;
    for (int shift = 0; shift < repetitions; ++shift) {
      int sign = 1;
      for (std::size_t i = 0; i < pairs; ++i) {
        const double index = atlas.orbits().reals("stability")[orbit * pairs + i];
        const double angle = std::acos(std::clamp(0.5 * index, -1.0, 1.0));
        const int turns = static_cast<int>(std::lround(angle * repetitions / (2.0 * std::numbers::pi)));
        if (shift * turns % repetitions != 0) continue;        // the shift leaves nothing of this pair alone
        if (turns != 0 && 2 * turns != repetitions) continue;  // a pair off the real axis
        const double gap = turns == 0 ? 2.0 - index : 2.0 + index;
        if (!(std::abs(gap) > error)) return std::nullopt;
        if (gap < 0.0) sign = -sign;
      }
      sum += sign;
    }
    return sum / repetitions;
  }

  static void judge(const Evidence& evidence, std::size_t equilibrium, const KernelRecord& kernel,
                    std::vector<Finding>& found) {
    Finding finding;
    finding.kind = FindingKind::equilibrium_families;
    finding.period = kernel.period * evidence.known.time_unit;
    finding.other_number = kernel.dimension;
    finding.severity = Severity::contradiction;
    for (std::size_t f = 0; f < kernel.places.size(); ++f) {
      const std::vector<int> rows = rows_of(evidence, equilibrium, kernel.places[f]);
      if (rows.empty()) finding.severity = std::max(finding.severity, Severity::cut);
      for (const int row : rows) {
        if (finding.family < 0) finding.family = row;
        const std::optional<int> index = index_of(evidence, row, kernel.repetitions[f]);
        if (index)
          finding.number += *index * kernel.images[f] / static_cast<int>(rows.size());
        else
          finding.severity = std::max(finding.severity, Severity::undecided);
      }
    }
    if (finding.severity == Severity::contradiction && finding.number == finding.other_number) return;
    if (finding.severity == Severity::contradiction && finding.family >= 0)
      finding.severity = evidence.severity_about(finding.family);
    finding.deviation = finding.other_number - finding.number;
    found.push_back(finding);
  }

  /// Of the stored bound.
  static constexpr double error_margin = 10.0;
};

}  // namespace orbweaver::survey
