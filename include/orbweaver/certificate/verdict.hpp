#pragma once

#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::certificate {

/// What a certificate says of its orbit.
enum class Verdict {
  holds,
  says_nothing,         ///< the integration is off by as much as the orbit is large, as its multipliers allow
  closure_contradicts,  ///< it is off by more than the orbit's residual and its multipliers explain
  drift_contradicts,    ///< the energy changes along the orbit by more than its residual explains
};
[[nodiscard]] constexpr Verdict last_of(Verdict) { return Verdict::drift_contradicts; }

/// What is known of an orbit besides: what its solver and its multipliers say.
struct Evidence {
  double period = 0.0;
  double residual = 0.0;   ///< rms |dz/dt - f|
  double amplitude = 0.0;  ///< rms distance from its mean
  double growth = 0.0;     ///< the largest modulus of its multipliers or indices; NaN: not known
};

/// A certificate in the light of the evidence (docs/mathematics.md, "Certificates").
struct Judgement {
  Verdict verdict = Verdict::holds;
  double found = 0.0;    ///< the closure, or the drift where that contradicts
  double allowed = 0.0;  ///< what the verdict holds it against
  double period = 0.0;   ///< of the orbit
  double growth = 0.0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, verdict, found, allowed, period, growth);
  }
};

[[nodiscard]] Judgement judge(const Certificate& certificate, const Evidence& evidence);

}  // namespace orbweaver::certificate
