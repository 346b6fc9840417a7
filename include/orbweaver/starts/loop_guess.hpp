#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/starts/guess_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The loop of period `period` through `states` at the times period j/n, j = 0 ... n, n >= 4: it winds as the states do
/// between the first and the last, and what these miss of closing is spread evenly over the period. Harmonics that a
/// guess need not have are left out.
[[nodiscard]] loop::Loop loop_through(const systems::Structure& structure,
                                      const std::vector<std::vector<double>>& states, double period);

/// The same along a curve, with s even in time where 960 samples resolve it; else s runs as fast as the motion
/// (map_to_motion), and there are as many samples as it takes.
[[nodiscard]] loop::Loop loop_through(const systems::Structure& structure, const GuessCurve& curve);

/// The curve through states at any ascending times within a period, at least four; neighbours differ by less than half
/// a turn of each angle, whole turns apart. A last state a whole period after the first one says how the curve closes;
/// otherwise it closes along less than half a turn. Between the times it runs along a cubic spline (Akima's, modified).
/// Throws InputError where the field along it is not finite.
[[nodiscard]] GuessCurve curve_through(const systems::System& system, const std::vector<double>& times,
                                       std::vector<std::vector<double>> states, double period);

}  // namespace orbweaver::starts
