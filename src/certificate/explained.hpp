#pragma once

#include <limits>

namespace orbweaver::certificate {

/// Of |z|: what the integrator's tolerance and rounding leave.
inline constexpr double integration_error = 1e-13;
/// How much more than its residual lets expect an orbit may be off. The closures of 10,000 orbits of the double
/// pendulum, the swinging spring and the restricted problem were at most 5 times that, their drifts 0.6 times.
inline constexpr double unexplained = 1e3;
/// Of |H|: what summing its terms leaves, however small the orbit is. Measured: up to 2 eps at amplitudes of 1e-7.
inline constexpr double energy_roundings = 32.0 * std::numeric_limits<double>::epsilon();

/// Of |z|: an error that has grown to more goes anywhere, and a return says nothing.
inline constexpr double nearby = 0.1;

}  // namespace orbweaver::certificate
