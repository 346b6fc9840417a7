#pragma once

#include <span>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::loop {

/// How the loop parameter s runs with time, t = T phi(s) (docs/mathematics.md, "Time map"): more of s, and so more of
/// the harmonics' resolution, where the orbit moves fast. The identity by default.
///
///   2 pi phi(s) = s + atan2((kappa - 1) sin s cos s, cos^2 s + kappa sin^2 s)
///                 + sum_k (c_k sin ks + d_k (1 - cos ks)) / k
///
/// The first part is psi with tan psi = kappa tan s: a symmetric pulse at s = pi/2 and 3 pi/2 for kappa > 1, invariant
/// under s -> -s and s -> s + pi.
struct TimeMap {
  double kappa = 1.0;                ///< > 0; 1 = no pulse
  std::vector<double> coefficients;  ///< c_1, d_1, c_2, d_2, ...; empty = none

  [[nodiscard]] bool is_identity() const;
  /// 2 pi phi(s), for any real s: grows by 2 pi a turn.
  [[nodiscard]] double phase(double s) const;
  /// 2 pi phi'(s) > 0, with mean 1.
  [[nodiscard]] double density(double s) const;
  /// The s with phase(s) = `phase`, to rounding.
  [[nodiscard]] double inverse(double phase) const;

  /// The s at which this map's time is that of `other` at `s`, to rounding: what inverse(other.phase(s)) is, but for
  /// the rounding of the phase, which counts 1/density times.
  [[nodiscard]] double parameter_at(const TimeMap& other, double s) const;

  /// `phase` and `parameter_at` at many parameters, side by side in the lanes of SIMD registers: the same to rounding.
  [[nodiscard]] std::vector<double> phases(std::span<const double> s) const;
  [[nodiscard]] std::vector<double> parameters_at(const TimeMap& other, std::span<const double> s) const;

  /// True if phase(s + 2 pi turns) = phase(s) + 2 pi turns for all s: only every q-th coefficient for turns = p/q, and
  /// half turns where kappa is not 1.
  [[nodiscard]] bool is_invariant_under_shift(double turns) const;
  /// The map of the same curve with s counted from s = `shift` on: phase(s + shift) - phase(shift). Where kappa does
  /// not allow the shift, its pulse is written as coefficients, to rounding.
  [[nodiscard]] TimeMap shifted(double shift) const;
  /// The map of the curve run backwards: -phase(-s).
  [[nodiscard]] TimeMap reversed() const;

  friend bool operator==(const TimeMap&, const TimeMap&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, kappa, coefficients);
  }
};

/// The densities at the nodes s_j = 2 pi j / nodes: the weights of means over time, mean g = (1/nodes) sum_j density_j
/// g_j.
[[nodiscard]] std::vector<double> densities(const TimeMap& map, int nodes);

/// Nodes beyond which the density's harmonics are below rounding: what means over time need besides the integrand's
/// own.
[[nodiscard]] int nodes_to_resolve(const TimeMap& map);

/// As stored in the archive: kappa, c_1, d_1, ...; empty for the identity.
[[nodiscard]] std::vector<double> to_numbers(const TimeMap& map);
/// Throws MisuseError for kappa <= 0, an even count, numbers that are not finite, or a density that is not positive.
[[nodiscard]] TimeMap time_map_of(const std::vector<double>& numbers);

}  // namespace orbweaver::loop
