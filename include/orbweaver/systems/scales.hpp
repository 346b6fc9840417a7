#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::systems {

/// The units in which a system's numbers are told, each in the units of its parameters (docs/mathematics.md, "Scales"):
/// a time t stands for t * time, coordinate i of a state z for z_i * coordinate(i), value n of the parameters that move
/// along families (FamilyScalars) for p_n * parameter(n). Angles have 1, in radians.
struct Scales {
  double time = 1.0;
  std::vector<double> coordinates;  ///< one a coordinate; empty: all 1
  std::vector<double> conserved;    ///< one a conserved quantity; empty: all 1
  std::vector<double> parameters;   ///< one a parameter that moves; empty: all 1

  [[nodiscard]] double coordinate(std::size_t i) const { return coordinates.empty() ? 1.0 : coordinates[i]; }
  [[nodiscard]] double parameter(std::size_t n) const { return parameters.empty() ? 1.0 : parameters[n]; }
  /// Of the first conserved quantity.
  [[nodiscard]] double energy() const { return conserved.empty() ? 1.0 : conserved.front(); }
  [[nodiscard]] double action() const { return energy() * time; }
  [[nodiscard]] bool are_one() const {
    const auto is_one = [](double scale) { return scale == 1.0; };
    return time == 1.0 && std::all_of(coordinates.begin(), coordinates.end(), is_one) &&
           std::all_of(conserved.begin(), conserved.end(), is_one) &&
           std::all_of(parameters.begin(), parameters.end(), is_one);
  }
  [[nodiscard]] bool operator==(const Scales&) const = default;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, time, coordinates, conserved, parameters);
  }
};

}  // namespace orbweaver::systems
