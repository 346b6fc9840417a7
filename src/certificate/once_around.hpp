#pragma once

#include "orbweaver/certificate/certificate.hpp"
#include "states.hpp"

namespace orbweaver::certificate {

/// An orbit as it is integrated once around: its states at the segments' starts and after its period.
struct Trip {
  const systems::System& system;
  const States& states;
  double period;
  double reach;      ///< the largest |z|
  double tolerance;  ///< of the integrator
};

struct OnceAround {
  double distance = unknown;          ///< from where it began, after its period
  double displaced_growth = unknown;  ///< of an error on the way, where the return is far off
};

/// NaN where the orbit is so unstable that the integration leaves the region where the system is defined. The growth is
/// that of integrations with steps of their own: what rounding grows to on the way counts too. `known_growth`: of
/// multipliers, NaN where none are known.
[[nodiscard]] OnceAround once_around(const Trip& trip, double known_growth);

}  // namespace orbweaver::certificate
