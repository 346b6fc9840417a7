#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/numerics/lagrange.hpp"
#include "tasks/payload/keys.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// A family of small oscillations begins at its equilibrium, with the period of its oscillation (docs/mathematics.md,
/// "What adds up"): its first orbits lead back there in energy, action and period.
class BaseBirths final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    const systems::Structure& structure = evidence.system->structure();
    if (!structure.conservative()) return found;
    for (std::size_t n = 0; n < evidence.known.oscillations.size(); ++n)
      for (const Oscillation& oscillation : evidence.known.oscillations[n]) {
        if (is_shared(evidence, n, oscillation.place)) continue;
        const std::string key = base_key(static_cast<int>(n), oscillation.place);
        for (const char* side : {"", "+", "-"})
          if (const int row = evidence.row_of(key + side); row >= 0)
            if (std::optional<Finding> finding = judged(evidence, row, n, oscillation.period))
              found.push_back(*finding);
      }
    return found;
  }

 private:
  /// Of the differences of periods that show how they run to the equilibrium.
  static constexpr double safety = 2.0;
  /// Where rounding may change more than this part of a period nothing is told.
  static constexpr double telling = 0.1;
  static constexpr std::size_t orbits_asked = 3;

  /// Along combinations of oscillations that nearly share a period T does not run smoothly with E; their families are
  /// counted instead.
  static bool is_shared(const Evidence& evidence, std::size_t equilibrium, int place) {
    if (equilibrium >= evidence.known.kernels.size()) return false;
    const std::vector<KernelRecord>& kernels = evidence.known.kernels[equilibrium];
    return std::any_of(kernels.begin(), kernels.end(), [&](const KernelRecord& kernel) {
      return std::find(kernel.places.begin(), kernel.places.end(), place) != kernel.places.end();
    });
  }

  static double energy_at(const Evidence& evidence, std::size_t equilibrium) {
    const systems::Scales& units = evidence.system->scales();
    std::vector<double> point = evidence.known.equilibria[equilibrium];
    for (std::size_t i = 0; i < point.size(); ++i) point[i] /= units.coordinate(i);
    return evidence.system->conserved(0, point) * units.energy();
  }

  // W is the integral of T dE from the equilibrium on, so that W over the difference in energy is a mean of the
  // periods in between; and the periods, as functions of the energy, lead back to the oscillation's.
  static std::optional<Finding> judged(const Evidence& evidence, int row, std::size_t equilibrium, double period) {
    const TreeFamily& family = evidence.family(row);
    const auto& steps = evidence.tree.atlas.orbits().integers("step");
    const auto at = steps.begin() + static_cast<std::ptrdiff_t>(family.first_orbit);
    const auto first =
        static_cast<std::size_t>(std::lower_bound(at, at + static_cast<std::ptrdiff_t>(family.orbits()), 0) - at);
    if (first + orbits_asked > family.orbits()) return std::nullopt;
    const double rest = energy_at(evidence, equilibrium);
    std::array<double, orbits_asked> energies{};
    std::array<double, orbits_asked> periods{};
    for (std::size_t n = 0; n < orbits_asked; ++n) {
      energies[n] = family.curve.points()[first + n].value(Invariant::level) - rest;
      periods[n] = family.curve.points()[first + n].value(Invariant::period);
    }
    const Invariants& orbit = family.curve.points()[first];
    const double energy_floor =
        orbit.floor_of(Invariant::level) + std::numeric_limits<double>::epsilon() * std::abs(rest);
    const double floor = energy_floor / std::abs(energies[0]) + orbit.floor_of(Invariant::period) / period +
                         orbit.floor_of(Invariant::action) / std::abs(period * energies[0]);
    if (!(floor < telling)) return std::nullopt;
    const double line = through(energies, periods, 2);
    const double parabola = through(energies, periods, 3);
    const auto [least, most] = std::minmax({periods[0], periods[1], periods[2], line, parabola});
    // At resonances T goes with the amplitude, the root of the energy: then a line misses by so much more.
    const double by_root = std::sqrt(std::max(1.0, std::abs(energies[1] / energies[0])));
    const double allowed = safety * by_root * (most - least) + floor * period;
    const double mean = orbit.value(Invariant::action) / energies[0];
    const double off = std::max({std::abs(parabola - period), least - mean, mean - most});
    if (off <= allowed) return std::nullopt;
    Finding finding;
    finding.kind = FindingKind::base_birth;
    finding.severity = evidence.severity_about(row);
    finding.family = row;
    finding.period = periods[0];
    finding.level = orbit.value(Invariant::level);
    finding.deviation = off / period;
    return finding;
  }

  /// The value at 0 of the polynomial through the first `count` values at `x`.
  static double through(const std::array<double, orbits_asked>& x, const std::array<double, orbits_asked>& values,
                        std::size_t count) {
    const std::vector<double> weights = numerics::lagrange_weights(std::span<const double>(x.data(), count), 0.0).value;
    double sum = 0.0;
    for (std::size_t n = 0; n < count; ++n) sum += weights[n] * values[n];
    return sum;
  }
};

}  // namespace orbweaver::survey
