#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::loop {

/// One spatio-temporal symmetry of a loop, acting modulo whole turns of the angles.
/// Equivariance `S@p/q`: z(t + T p/q) = S z(t). Reversor `R@p/q`: z(T p/q - t) = R z(t). The maps are affine;
/// perturbations of the loop, and what stands relative to a point that they map to itself, see their matrices only.
struct SymmetryElement {
  std::string name;
  bool reversing = false;
  systems::AffineMap map;
  int shift_numerator = 0;
  int shift_denominator = 1;

  [[nodiscard]] double shift() const { return static_cast<double>(shift_numerator) / shift_denominator; }

  /// The matrix does not travel: who receives an element looks it up by its name (with_declared_matrices).
  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, name, reversing, shift_numerator, shift_denominator);
  }
};

/// The declared symmetries that a loop has: generators of its isotropy group, in the system's order.
using Isotropy = std::vector<SymmetryElement>;

/// The isotropy as it was received, with the matrices that `system` declares. Throws EnvironmentError for a name that
/// it does not, and for shifts that are none.
[[nodiscard]] Isotropy with_declared_matrices(Isotropy isotropy, const systems::Structure& system);

/// "S@1/2 R@0": equivariances first, then reversors; empty text for no symmetry.
[[nodiscard]] std::string to_text(const Isotropy& isotropy);

/// `element` applied to a loop: the loop w with w = g z (for a symmetry of z, w = z up to the lattice).
[[nodiscard]] Loop transformed(const Loop& loop, const SymmetryElement& element);

/// The same for any time shift, in parts of the period: w(t) = M^-1 z(t + T shift), or M^-1 z(T shift - t) if
/// `reversing`.
[[nodiscard]] Loop transformed(const Loop& loop, const systems::AffineMap& map, bool reversing, double shift);

/// `element` applied to a perturbation of a loop: by its matrix alone.
[[nodiscard]] Loop transformed_perturbation(const Loop& perturbation, const SymmetryElement& element);

/// How far `element` is from being a symmetry of the loop: mean distance of z and g z, angles modulo 2 pi.
[[nodiscard]] double symmetry_defect(const Loop& loop, const SymmetryElement& element, const std::vector<int>& angles);

/// What a symmetry of a converged loop of size 1 may be off: sqrt(loss) is below 1e-10 and modes are good to that over
/// the smallest singular value, while a symmetry that is broken is off by the amplitude that breaks it.
inline constexpr double symmetry_tolerance = 1e-7;

/// Generators of the isotropy of `loop`: the declared symmetries of `system` that hold to `tolerance` with a time shift
/// p/q, q <= `max_denominator` (the smallest that holds), products of earlier ones left out. s = 0 must already lie on
/// the reversor's fixed set for a reversor to be seen at shift 0.
[[nodiscard]] Isotropy find_isotropy(const systems::Structure& system, const Loop& loop, double tolerance,
                                     int max_denominator = 4);

/// A declared symmetry of `system` (or the identity, named "1") with a time shift p/q, q <= `max_denominator`, that
/// maps `from` to `to` within `tolerance` (mean distance, angles modulo 2 pi); none if there is none.
[[nodiscard]] std::optional<SymmetryElement> find_map(const systems::Structure& system, const Loop& from,
                                                      const Loop& to, double tolerance, int max_denominator = 4);

}  // namespace orbweaver::loop
