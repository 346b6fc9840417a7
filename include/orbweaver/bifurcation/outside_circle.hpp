#pragma once

#include <optional>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::bifurcation {

/// Multipliers of a dissipative system's orbit outside the unit circle.
struct OutsideCircle {
  int beyond_one = 0;        ///< real ones above 1
  int beyond_minus_one = 0;  ///< real ones below -1
  int pairs = 0;             ///< complex pairs

  friend bool operator==(const OutsideCircle&, const OutsideCircle&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, beyond_one, beyond_minus_one, pairs);
  }
};

/// Those of the fundamental map, a conserved energy's 1 left out. None where the error bound of one leaves open on
/// which side of the circle it is, or one is not a number, and of symplectic systems.
[[nodiscard]] std::optional<OutsideCircle> outside_circle(const systems::Structure& system,
                                                          const spectrum::Stability& stability);

/// How often multipliers pass the unit circle between two orbits of a family.
struct CirclePassages {
  int at_one = 0;
  int at_minus_one = 0;
  int as_pairs = 0;  ///< complex pairs, each once

  friend bool operator==(const CirclePassages&, const CirclePassages&) = default;
};

/// The fewest passages that lead from the one to the other. Outside the circle two real multipliers may meet, turn as a
/// complex pair, and come back to the real axis elsewhere, so that their numbers beyond 1 and beyond -1 change by two
/// and nothing passes: of each number its parity tells, and all three together how many have passed the circle. Real
/// ones count as having stayed on the axis where that takes no more passages.
[[nodiscard]] CirclePassages least_passages(const OutsideCircle& from, const OutsideCircle& to);

}  // namespace orbweaver::bifurcation
