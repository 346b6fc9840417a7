#pragma once

#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::bifurcation {

/// The rotation of a pair at another orbit of its family.
struct Counterpart {
  const spectrum::Rotation* rotation = nullptr;  ///< null: none is told to be its
  double overlap = 0.0;                          ///< of the planes; negative where it goes around the other way

  [[nodiscard]] explicit operator bool() const { return rotation != nullptr; }
};

/// The product of the cosines of two planes' angles, negative where they go around in different ways.
[[nodiscard]] double overlap(const spectrum::Rotation& a, const spectrum::Rotation& b);

/// In the plane that the rotation's has become at another orbit, not far along the family.
[[nodiscard]] Counterpart counterpart(const spectrum::Rotation& of, const spectrum::Stability& there);

}  // namespace orbweaver::bifurcation
