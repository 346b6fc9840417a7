#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/archive/schema/schema.hpp"
#include "tasks/payload/keys.hpp"
#include "tasks/payload/sweep_work.hpp"
#include "witness/check.hpp"
#include "witness/stored_stability.hpp"

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
    if (archive::stability_width(header) == 0 || !evidence.system->structure().symplectic) return found;
    for (std::size_t n = 0; n < evidence.known.kernels.size(); ++n)
      for (const KernelRecord& kernel : evidence.known.kernels[n])
        if (kernel.is_definite && !kernel.places.empty()) judge(evidence, n, kernel, found);
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
  static std::optional<int> index_of(const Evidence& evidence, int row, int repetitions, int dimension) {
    const TreeFamily& family = evidence.family(row);
    const auto& steps = evidence.tree.atlas.orbits().integers("step");
    double until = std::numeric_limits<double>::infinity();
    for (const int crossing : family.crossings)
      until = std::min(until, evidence.tree.atlas.crossings().reals("arclength")[static_cast<std::size_t>(crossing)]);
    for (std::size_t n = 0; n < family.orbits(); ++n) {
      if (steps[family.first_orbit + n] < 0) continue;
      if (family.arclengths[n] >= until) break;
      if (const auto index = index_of_orbit(evidence, family.first_orbit + n, repetitions, dimension)) return index;
    }
    return std::nullopt;
  }

  /// A stability index of an orbit, and the root of unity of the `repetitions` that its multiplier is nearest to.
  struct Pair {
    std::complex<double> index;
    int turns = 0;
    double off = 0.0;  ///< of the index from that root's
  };

  /// Of all pairs of an orbit those that come from the kernel, in which every oscillation goes around a whole number of
  /// times while the repetitions pass: beside the equilibrium they are near those roots. None where another is as near.
  static std::optional<std::vector<Pair>> kernel_pairs(const Evidence& evidence, std::size_t orbit, int repetitions,
                                                       int dimension) {
    const archive::Header& header = evidence.tree.atlas.header();
    const std::size_t width = archive::stability_width(header);
    const std::size_t parts = archive::has_complex_stability(header) ? 2 : 1;
    const std::vector<double>& stability = evidence.tree.atlas.orbits().reals("stability");
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < width; i += parts) {
      const double* index = &stability[orbit * width + i];
      Pair pair{{index[0], parts == 2 ? index[1] : 0.0}};
      const double angle = std::acos(std::clamp(0.5 * pair.index.real(), -1.0, 1.0));
      pair.turns = static_cast<int>(std::lround(angle * repetitions / (2.0 * std::numbers::pi)));
      pair.off = std::abs(pair.index - 2.0 * std::cos(2.0 * std::numbers::pi * pair.turns / repetitions));
      if (!std::isfinite(pair.off)) return std::nullopt;
      pairs.push_back(pair);
    }
    const auto own = static_cast<std::size_t>(dimension - 1);
    if (own > pairs.size()) return std::nullopt;
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.off < b.off; });
    if (own > 0 && own < pairs.size() && !(pairs[own].off > beside_kernel * pairs[own - 1].off)) return std::nullopt;
    pairs.resize(own);
    return pairs;
  }

  /// The index of an orbit among all orbits of its energy modulo time shifts: of a vector field on the quotient by the
  /// group of the `repetitions`, with as many signs as elements.
  static std::optional<int> index_of_orbit(const Evidence& evidence, std::size_t orbit, int repetitions,
                                           int dimension) {
    const auto pairs = kernel_pairs(evidence, orbit, repetitions, dimension);
    if (!pairs) return std::nullopt;
    const double error = bifurcation::error_margin * evidence.tree.atlas.orbits().reals("stability_error")[orbit];
    int sum = 0;
    for (int shift = 0; shift < repetitions; ++shift) {
      int sign = 1;
      for (const Pair& pair : *pairs) {
        if (shift * pair.turns % repetitions != 0) continue;             // the shift leaves nothing of this pair alone
        if (pair.turns != 0 && 2 * pair.turns != repetitions) continue;  // a pair off the real axis
        const std::complex<double> gap = pair.turns == 0 ? 2.0 - pair.index : 2.0 + pair.index;
        if (!(std::abs(gap) > error)) return std::nullopt;
        if (std::abs(gap.imag()) > error) continue;  // its conjugate is another pair's, and the product positive
        if (gap.real() < 0.0) sign = -sign;
      }
      sum += sign;
    }
    return sum / repetitions;
  }

  /// "1 : 2 : 3": how many times the oscillations go around together.
  static std::string resonance_of(const KernelRecord& kernel) {
    std::vector<int> times = kernel.repetitions;
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    if (times.size() == 1) times.resize(static_cast<std::size_t>(std::max(1, kernel.dimension)), times.front());
    return fmt::to_string(fmt::join(times, " : "));
  }

  static void judge(const Evidence& evidence, std::size_t equilibrium, const KernelRecord& kernel,
                    std::vector<Finding>& found) {
    Finding finding;
    finding.kind = FindingKind::equilibrium_families;
    finding.period = kernel.period * evidence.known.time_unit;
    finding.other_number = kernel.dimension;
    finding.severity = Severity::contradiction;
    std::vector<std::string> names;
    for (std::size_t f = 0; f < kernel.places.size(); ++f) {
      const std::vector<int> rows = rows_of(evidence, equilibrium, kernel.places[f]);
      if (rows.empty()) finding.severity = std::max(finding.severity, Severity::cut);
      for (const int row : rows) {
        if (finding.family < 0) finding.family = row;
        names.push_back(evidence.family(row).name);
        const std::optional<int> index = index_of(evidence, row, kernel.repetitions[f], kernel.dimension);
        if (index)
          finding.number += *index * kernel.images[f] / static_cast<int>(rows.size());
        else
          finding.severity = std::max(finding.severity, Severity::undecided);
      }
    }
    if (finding.severity == Severity::contradiction && finding.number == finding.other_number) return;
    if (finding.severity == Severity::contradiction && finding.family >= 0)
      finding.severity = evidence.severity_about(finding.family);
    // Which pairs of multipliers come from the kernel is told by their size alone.
    if (kernel.dimension != evidence.tree.atlas.header().pairs + 1)
      finding.severity = std::max(finding.severity, Severity::undecided);
    finding.deviation = finding.other_number - finding.number;
    finding.detail = fmt::format("{}, {}", resonance_of(kernel), fmt::join(names, ", "));
    found.push_back(finding);
  }

  /// Pairs that do not come from the kernel are so many times further from its roots of unity. Not measured.
  static constexpr double beside_kernel = 30.0;
};

}  // namespace orbweaver::survey
