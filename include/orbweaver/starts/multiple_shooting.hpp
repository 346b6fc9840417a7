#pragma once

#include <optional>

#include "orbweaver/starts/guess_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// What a trajectory is followed by.
struct Integrator {
  Advance advance;
  /// The derivative of the state after a time by the state, row after row.
  Advance transition;
  double tolerance = 0.0;  ///< of both
};

/// An orbit near a curve, of its period (of any, where nothing is conserved), by multiple shooting: Newton's method on
/// the states at the curve's slow places. Between these lie the close passages, over which errors grow no more than
/// beside them, while a state within one leads elsewhere if it is moved by the passage's own small time.
struct ShotCurve {
  std::optional<GuessCurve> curve;  ///< from one of the slow places on; none where Newton's method does not converge
  double missed = 0.0;              ///< what the piece that misses the next one's beginning the most misses it by
  double missed_at = 0.0;           ///< the time, on the given curve, at which that piece ends
};
/// `longest`: of the steps of the curve's mesh.
[[nodiscard]] ShotCurve shot_through(const systems::System& system, const Integrator& integrator,
                                     const GuessCurve& curve, double longest);

}  // namespace orbweaver::starts
