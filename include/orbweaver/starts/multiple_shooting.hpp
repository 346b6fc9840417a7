#pragma once

#include <functional>
#include <vector>

#include "orbweaver/starts/guess_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// What a trajectory is followed by.
struct Integrator {
  Advance advance;
  /// The derivative of the state after a time by the state, row after row.
  Advance transition;
};

/// A curve brought nearer to an orbit of its period (of any, where nothing is conserved and nothing drives) by multiple
/// shooting: damped steps of Newton's method on states along it, between which the motion turns alike, however fast it
/// is. `missed`: what the pieces between these states miss the next ones by, together; where Newton's method finds no
/// orbit it stays above the integrator's error.
struct ShotCurve {
  GuessCurve curve;
  double missed = 0.0;
  double missed_at = 0.0;  ///< the time, on the curve, at which the most is missed
};
[[nodiscard]] ShotCurve shot_through(const systems::System& system, const Integrator& integrator,
                                     const GuessCurve& curve, double longest);

}  // namespace orbweaver::starts
