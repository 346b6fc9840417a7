#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::bifurcation {

/// How far a crossing may lie from the place where it was located. NaN: not known, or the families have none.
struct PlaceError {
  double arclength = std::numeric_limits<double>::quiet_NaN();  ///< along the family
  double period = std::numeric_limits<double>::quiet_NaN();     ///< by how much it changes over that arclength, at most
  double energy = std::numeric_limits<double>::quiet_NaN();     ///< the same
  double parameter = std::numeric_limits<double>::quiet_NaN();  ///< the same of the parameter that moves

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, arclength, period, energy, parameter);
  }
};

/// A function along a family with the bound of its error, by position; NaN where it has no value.
using BoundedFunction = std::function<Reading(double position)>;

/// A zero lies between `place - before` and `place + behind`.
struct Enclosure {
  double before = 0.0;
  double behind = 0.0;
  bool is_told = true;  ///< the function exceeds its error there, on both sides; else it does so nowhere up to an end
};

/// The nearest places on both sides of a computed zero, or of a minimum that touches zero, at which the function has
/// the sign that it has at that end of its bracket [from, to] by more than its error: the true zero lies between them,
/// with whatever power of the distance the function vanishes. They are found to a factor of two, or to `least`.
/// `asked`: positions where the function is known already.
[[nodiscard]] Enclosure enclosure_of_zero(const BoundedFunction& function, const std::vector<double>& asked,
                                          double place, double from, double to, double least);

}  // namespace orbweaver::bifurcation
