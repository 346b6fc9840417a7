#pragma once

#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// How a loop and its scalars change: a direction in which orbits lie, or the difference of two of them. Lengths and
/// inner products are those of the coefficients and scalars as numbers.
struct Tangent {
  std::vector<double> modes;    ///< (2K + 1) x dimension, as those of a Loop; empty: unknown
  std::vector<double> scalars;  ///< of T first, then of the parameters that move along; those left out do not change

  [[nodiscard]] bool empty() const { return modes.empty(); }
  [[nodiscard]] double period() const { return scalars.empty() ? 0.0 : scalars.front(); }
  [[nodiscard]] double norm() const;
  /// To length 1. Throws MisuseError for one that is zero.
  void normalize();
  Tangent& operator*=(double factor);
  bool operator==(const Tangent&) const = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, modes, scalars);
  }
};

[[nodiscard]] double dot(const Tangent& a, const Tangent& b);

/// The same for a loop with another cutoff: padded with zeros or truncated.
[[nodiscard]] Tangent with_cutoff(Tangent tangent, int cutoff, int dimension);

/// The same for `at`, to which it belongs, under another time map (as loop::with_time_map).
[[nodiscard]] Tangent with_time_map(const Loop& at, const Tangent& tangent, const TimeMap& map, int cutoff);

/// The same for `at`, to which it belongs, gone around `times` times (as loop::repeated).
[[nodiscard]] Tangent repeated(const Loop& at, const Tangent& tangent, int times);

/// The change of z(s) as a loop: without winding, with the period and the time map of `at`.
[[nodiscard]] Loop perturbation(const Loop& at, const Tangent& tangent);

/// base + step * tangent, modes, period and parameters. The tangent needs the cutoff of the base.
[[nodiscard]] Loop moved(Loop base, const Tangent& tangent, double step);

/// |dz(s = 0)| for a step of length 1 times the tangent.
[[nodiscard]] double change_at_start(const Loop& at, const Tangent& tangent);

}  // namespace orbweaver::loop
