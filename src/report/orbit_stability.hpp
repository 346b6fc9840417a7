#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Whether the archive's stability values are multipliers; else they are indices mu + 1/mu of symplectic pairs.
[[nodiscard]] bool holds_multipliers(const archive::Archive& atlas);

/// Which orbits of an archive are linearly stable. It must not outlive the archive.
class OrbitStability {
 public:
  explicit OrbitStability(const archive::Archive& atlas);

  /// True if all indices are between -2 and 2, and real within `stability_error`, or all multipliers within the unit
  /// circle, by more than that error; of a single multiplier that is not known, if its logarithm says so. Nothing where
  /// they are not known, where one is on the border within its error and none beyond, or where the error exceeds 1e-3
  /// and leaves it open.
  [[nodiscard]] std::optional<bool> of(std::size_t orbit) const;

  /// The decimal logarithm of the largest multiplier's absolute value; NaN where it is not known.
  [[nodiscard]] double log10_growth(std::size_t orbit) const;

 private:
  [[nodiscard]] std::optional<bool> by_volume(std::size_t orbit) const;
  [[nodiscard]] std::complex<double> value(std::size_t orbit, std::size_t pair) const;

  const std::vector<double>& _values;
  const std::vector<double>& _errors;
  const std::vector<double>& _log_volumes;
  std::size_t _pairs;
  bool _complex;
  bool _multipliers;
  int _neutral;  // multipliers that are 1 along all families: the energy's own, where nothing pairs it
};

}  // namespace orbweaver::report
