#pragma once

#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::certificate {

/// Phi_time(state): the state that the system reaches from `state` (size dimension) after `time` (negative: before),
/// by Runge-Kutta-Fehlberg 7(8) with step control (Boost.odeint). The error of a step is kept below
/// `tolerance` (min(1, |z(0)|) + |z_i| + |dz_i|) in every coordinate, dz being the change of that step. Deterministic;
/// independent of the loop representation and of every solver.
///
/// At tolerance 1e-13 this takes 0.94 (double pendulum) and 0.72 (Henon-Heiles) times the field evaluations of a
/// Bulirsch-Stoer extrapolation for one certificate at a period of 10 with 32 segments; for one long integration 1.25
/// times.
///
/// Throws core::MisuseError if the size is not the dimension, `time` is not finite or `tolerance` not in [1e-15, 0.1];
/// core::NumericalError, naming the time reached, if the field or the state ceases to be finite or a million steps do
/// not suffice.
[[nodiscard]] std::vector<double> integrate(const systems::System& system, std::vector<double> state, double time,
                                            double tolerance);

/// The same for several states over one time, with common steps: as many at a time as a vector register holds, which
/// the field is evaluated at together. Each ends where `integrate` would take it, within the tolerance.
[[nodiscard]] std::vector<std::vector<double>> integrate_together(const systems::System& system,
                                                                  const std::vector<std::vector<double>>& states,
                                                                  double time, double tolerance);

/// dPhi_time/dz at each state (dimension x dimension, row after row), by the same method on dY/dt = df/dz Y, the error
/// of whose steps is kept below `tolerance` (1 + |Y|) as well.
[[nodiscard]] std::vector<std::vector<double>> transitions(const systems::System& system,
                                                           const std::vector<std::vector<double>>& states, double time,
                                                           double tolerance);

}  // namespace orbweaver::certificate
