#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/systems/affine_map.hpp"

namespace orbweaver::systems {

/// A symmetry of phase space, acting modulo 2 pi on the angles.
struct Symmetry {
  std::string name;  ///< "S", "R", "RS": as it appears in an isotropy
  AffineMap map;
};

/// A positive function of the state whose zeros orbits must not meet: there the field is not finite.
struct Guard {
  std::string name;  ///< "r2"
  std::string body;  ///< what is met where it is zero: "the smaller body"
};

/// What families of periodic orbits a system has, by what it conserves and what acts on it.
enum class FamilyKind {
  none,             ///< damped and not driven: motions come to rest
  conservative,     ///< one family through each orbit, along which a conserved quantity moves
  dissipative,      ///< isolated orbits, families in a parameter
  driven_damped,    ///< the same, with periods that are multiples of the drive's
  driven_undamped,  ///< the same, with multipliers in pairs
};

/// What holds for a system with its parameter values and effects. Everything that other layers do depends on this and
/// on the field alone.
struct Structure {
  int dimension = 0;
  std::vector<int> angles;              ///< indices of the coordinates that live on a circle of 2 pi and may wind
  std::vector<std::string> conserved;   ///< names of the conserved quantities; values and gradients are System's
  std::vector<Guard> guards;            ///< their values are System's
  std::vector<Symmetry> equivariances;  ///< S with f(S z) = S' f(z) (S': its matrix), identity excluded
  std::vector<Symmetry> reversors;  ///< R with f(R z) = -R' f(z), in the order in which they are preferred for s = 0
  /// Multipliers come in pairs mu, 1/mu; in an odd dimension, that of a driven system, all but the trivial one.
  bool symplectic = false;
  bool driven = false;       ///< the last coordinate is the phase of a drive, an angle that turns steadily
  bool dissipative = false;  ///< volumes of the space of states are not kept
  bool decays = false;       ///< its energy only falls: no motion but rest is periodic

  [[nodiscard]] bool is_angle(std::size_t coordinate) const {
    return std::find(angles.begin(), angles.end(), static_cast<int>(coordinate)) != angles.end();
  }
  [[nodiscard]] std::vector<std::string> guard_names() const {
    std::vector<std::string> names;
    for (const Guard& guard : guards) names.push_back(guard.name);
    return names;
  }
  [[nodiscard]] bool has_angles() const { return !angles.empty(); }
  [[nodiscard]] bool conservative() const { return !conserved.empty(); }
  /// Number of nontrivial stability indices of an orbit (pairs of multipliers).
  [[nodiscard]] int pairs() const { return symplectic ? (dimension - 1) / 2 : dimension - 1; }
  [[nodiscard]] FamilyKind family_kind() const {
    if (conservative()) return FamilyKind::conservative;
    if (decays) return FamilyKind::none;
    if (driven) return dissipative ? FamilyKind::driven_damped : FamilyKind::driven_undamped;
    return FamilyKind::dissipative;
  }
};

}  // namespace orbweaver::systems
