#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::certificate {

struct Options {
  int segments = 32;         ///< equal parts of the period, each integrated from the loop's own state
  double tolerance = 1e-13;  ///< of the integrator (integrate.hpp)
};

/// What an independent integrator says of one loop. Distances are Euclidean in the coordinates of phase space; an angle
/// that turns n times is expected to have grown by 2 pi n after a period.
struct Certificate {
  double closure = 0.0;  ///< largest |z(t_m+1) - Phi(z(t_m))| over the segments, z being the loop
  double single_shot =
      0.0;  ///< |z(T) - Phi_T(z(0))|: once around without help; grows with the largest multiplier; NaN if that fails
  double energy_drift = 0.0;  ///< largest |H(z(t_m)) - H(z(0))|; NaN for a system that conserves no energy
  double reach = 0.0;         ///< largest |z(t_m)|
  double steepness = 0.0;     ///< largest |dH/dz(z(t_m))|; 0 for a system that conserves no energy
};

/// Integrates the loop's own states and compares. Deterministic; knows no residual, loss or Jacobian.
/// Throws core::MisuseError if the loop is not valid or not of the system's dimension, `segments` < 1 or the tolerance
/// is out of range; core::NumericalError if an integration fails, saying in which segment and at what time.
[[nodiscard]] Certificate certify(const systems::System& system, const loop::Loop& loop, const Options& options = {});

/// The largest gap |z(t_m+1) - Phi(z(t_m))| over the segments by each of two integrators that have nothing in common
/// but the field: Runge and Kutta's of `integrate.hpp`, and Taylor series (taylor/flow.hpp).
struct Closures {
  double runge_kutta = 0.0;
  double taylor = 0.0;
  double apart = 0.0;  ///< the largest distance of their ends: what either may be wrong by
};

/// Throws what certify does, and core::MisuseError for a system that does not give its formulas.
[[nodiscard]] Closures closures(const systems::System& system, const loop::Loop& loop, const Options& options = {});

}  // namespace orbweaver::certificate
