#pragma once

#include <limits>
#include <string>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// How two orbits are told apart.
struct IdentityOptions {
  corrector::Options corrector{};
  int cutoff_to = 4096;
  double tolerance = continuation::same_orbit_tolerance;  ///< as `continuation::same_within` takes it
  /// Of the ranges of period, energy and action between neighbours, relative to their values: a first look, which may
  /// only pass too many.
  double widening = 1e-2;
  bool keeps_repetitions = false;  ///< an orbit that goes around several times is not taken for the one it goes around
};

/// What a comparison of an orbit with a family found.
struct Comparison {
  bool same = false;
  /// sqrt(mean |dz|^2 + (dT/T)^2) from the family's orbit that was corrected beside it, or from the chord or its ends
  /// where that was enough to tell; infinite where the invariants were.
  double distance = std::numeric_limits<double>::infinity();
  double position = std::numeric_limits<double>::quiet_NaN();  ///< of its projection on the chord: 0 at `a`, 1 at `b`
  std::string detail;                                          ///< how it was told
  bool decided = true;  ///< false: Newton's method found no orbit beside it, or left the family on the way

  explicit operator bool() const { return same; }
};

/// True unless period, energy or action of `x` lie outside those of the neighbours `a` and `b`: the range between the
/// two, widened at both ends by half of itself and by `widening` of the value (the energy's: of the mean of p . dq/dt).
/// Cheap.
[[nodiscard]] bool may_lie_between(const continuation::Orbit& a, const continuation::Orbit& b,
                                   const continuation::Orbit& x, double widening);

/// Are these the same orbit, modulo time shift, the system's symmetries and reversal, whole turns of angles, and
/// repetition (up to 12 times around)? To `tolerance` as in IdentityOptions.
[[nodiscard]] bool same_orbit(const systems::System& system, const loop::Loop& a, const loop::Loop& b,
                              double tolerance = IdentityOptions{}.tolerance);

/// Is `x` an orbit of the family with the isotropy `isotropy`, of which `a` and `b` are neighbours? Modulo time shift,
/// the system's symmetries and reversal, whole turns of angles, and repetition (`x` may go up to 12 times around).
///
/// x is brought to a (loop::align) and projected on the chord from a to b; the chord's orbit there is corrected within
/// the isotropy's subspace, orthogonally to the chord; the two are compared after another alignment
/// (docs/mathematics.md, "Identity"). Away from crossings the answer does not depend on the chord's length as long as
/// Newton's method converges from it.
[[nodiscard]] Comparison same_family(const systems::System& system, const continuation::Orbit& a,
                                     const continuation::Orbit& b, const loop::Isotropy& isotropy,
                                     const continuation::Orbit& x, const IdentityOptions& options = {});

}  // namespace orbweaver::bifurcation
