#pragma once

#include <string_view>

#include "orbweaver/certificate/certificate.hpp"

namespace orbweaver::certificate {

/// What a certificate says of its orbit; in the archive by its number, so none changes its place.
enum class Verdict {
  holds,
  says_nothing,         ///< the integration is off by as much as the orbit is large, as its multipliers allow
  closure_contradicts,  ///< a part of the period is off by more than the orbit's residual and its multipliers explain
  drift_contradicts,    ///< a conserved quantity changes along the orbit by more than its residual explains
  wrong_period,         ///< the closure is off, and all of it is explained by another period
  integrators_differ,   ///< two integrators do not take the orbit to the same place
  return_contradicts,   ///< once around is off by more than residual and multipliers explain
  not_symmetric,        ///< it has not the symmetries that its family claims
  not_minimal,          ///< a shorter orbit gone around several times
  truncated,            ///< its last harmonics are no smaller than a ten-thousandth of it
  unpaired,             ///< the product of its multipliers is not 1
  other_multipliers,    ///< its multipliers are others than the archive's, by more than their bound
  no_orbit_near,        ///< Newton's method does not find an orbit within a ten-thousandth of its amplitude
};
[[nodiscard]] constexpr Verdict last_of(Verdict) { return Verdict::no_orbit_near; }
/// "holds", "closure contradicts", ...
[[nodiscard]] std::string_view name_of(Verdict verdict);
/// Whether the orbit is not what it is said to be.
[[nodiscard]] constexpr bool is_failure(Verdict verdict) {
  return verdict != Verdict::holds && verdict != Verdict::says_nothing;
}

/// What is known of an orbit besides: what its solver and its multipliers say.
struct Evidence {
  double period = 0.0;
  double residual = 0.0;         ///< rms |dz/dt - f|
  double amplitude = 0.0;        ///< rms distance from its mean
  double growth = 0.0;           ///< the largest modulus of its multipliers or indices; NaN: not known
  double index = unknown;        ///< of a single pair
  double index_error = unknown;  ///< the bound on its error
  bool winds = false;            ///< an angle turns over: an orbit however little the rest of it moves
};

/// A certificate in the light of the evidence (docs/mathematics.md, "Certificates").
struct Judgement {
  Verdict verdict = Verdict::holds;
  double found = 0.0;    ///< what decided: the closure, or what the verdict names
  double allowed = 0.0;  ///< what the verdict holds it against
};

[[nodiscard]] Judgement judge(const Certificate& certificate, const Evidence& evidence);

}  // namespace orbweaver::certificate
