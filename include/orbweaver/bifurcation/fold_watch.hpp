#pragma once

#include <limits>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::bifurcation {

/// An extremum of the period, the energy or the parameter that moves along a family, between two positions.
struct Fold {
  enum class Quantity { period, energy, parameter } quantity;
  double from;
  double to;
};

/// Finds folds from the orbits of a family one after the other.
class FoldWatch {
 public:
  /// Changes of T, E and parameters below this, relative to the largest modulus so far, are the corrector's tolerance.
  static constexpr double visible_change = 1e-10;

  /// The folds that this orbit shows, between it and up to two earlier ones that differ by more than `visible_change`.
  /// Quantities that are NaN are passed over. Throws MisuseError unless positions increase.
  [[nodiscard]] std::vector<Fold> advance(double position, double period, double energy,
                                          double parameter = std::numeric_limits<double>::quiet_NaN());

  /// The slopes of the three along a family, towards larger positions; NaN for what is not asked.
  struct Slopes {
    double period = std::numeric_limits<double>::quiet_NaN();
    double energy = std::numeric_limits<double>::quiet_NaN();
    double parameter = std::numeric_limits<double>::quiet_NaN();
  };

  /// The folds before the family's last orbit that no orbit behind it shows: where the slope there and the last
  /// difference have opposite signs. `position`: of that orbit.
  [[nodiscard]] std::vector<Fold> finish(double position, const Slopes& slopes) const;

  /// One quantity's last two orbits that differ.
  struct Turn {
    double before = std::numeric_limits<double>::quiet_NaN();  ///< position of the earlier one
    double position = std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    double scale = 0.0;  ///< largest modulus so far
    int direction = 0;   ///< of the last change

    static constexpr int wire_version = 1;
    template <class Archive>
    void serialize(Archive& archive, unsigned /*version*/) {
      core::serialize_members(archive, before, position, value, scale, direction);
    }
  };

  Turn period;  ///< plain state, for checkpoints
  Turn energy;
  Turn parameter;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, energy, parameter);
  }
};

}  // namespace orbweaver::bifurcation
