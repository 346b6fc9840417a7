#pragma once

#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::bifurcation {

/// Perturbations v of an orbit with P v = exp(2 pi i j/q) v, P being its fundamental map (spectrum/floquet.hpp).
struct Sector {
  int q = 1;
  int j = 0;

  /// The stability index mu + 1/mu of the sector: 2 cos(2 pi j/q).
  [[nodiscard]] double index() const;
  /// Of the stability values (spectrum::Stability): that index, or the real part of the multiplier where values are
  /// multipliers.
  [[nodiscard]] double value(bool symplectic) const { return symplectic ? index() : 0.5 * index(); }
  /// m: orbits born in this sector close after m periods of theirs, m = q / gcd(q, p) with p the fundamental map's
  /// order.
  [[nodiscard]] int multiplicity(int fundamental_order) const;

  friend bool operator==(const Sector&, const Sector&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, q, j);
  }
};

/// All sectors with gcd(j, q) = 1 and 0 <= j <= q/2 (j and -j are conjugate) whose multiplicity is at most
/// `subharmonics`, ordered by q, then j: q = 1, 2, 3, 4, 6, 8, 8 for order 2 and 4 subharmonics. Throws MisuseError if
/// either is below 1.
[[nodiscard]] std::vector<Sector> sectors(int fundamental_order, int subharmonics);

}  // namespace orbweaver::bifurcation
