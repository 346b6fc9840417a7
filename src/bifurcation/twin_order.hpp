#pragma once

#include <vector>

#include "kernel_actions.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "search.hpp"

namespace orbweaver::bifurcation {

// In which order twins stand, the directions that no symmetry tells apart by its name, and which side of one is +. Only
// numbers that neither a time shift, nor a symmetry, nor the choice of kernel vectors changes decide
// (docs/mathematics.md, "Twins").

/// How far numbers of twins must lie apart to decide, relative to the larger: those of a crossing's orbit are right to
/// 1e-9, and those of orbits found beside it to the loss's tolerance, with differences of the order of their amplitude
/// or its square.
inline constexpr double of_crossings = 1e-6;
inline constexpr double of_orbits_found = 1e-9;

/// Whether `a`, whose first number that is further than `apart` from that of `b` is the larger one, stands first.
[[nodiscard]] bool stands_before(const std::vector<double>& a, const std::vector<double>& b, double apart);

/// The moduli of velocity and acceleration at s = 0 and 1/2, the larger of each first: where a loop is symmetric whose
/// reversor has phase 0.
[[nodiscard]] std::vector<double> at_symmetric_instants(const systems::System& system, const loop::Loop& loop);

/// The side of a line to which the first number grows that tells its sides apart, +1 or -1: of those at symmetric
/// instants where a reversor keeps the line with phase 0, else the mean speed. 0 where none tells them apart.
[[nodiscard]] int rising_side(const systems::System& system, const loop::Loop& base, const loop::Tangent& line,
                              bool is_reversible);

/// Orbits whose parts in the kernel have one length: by period, energy, mean speed, the larger first.
void put_in_order(const systems::System& system, std::vector<FoundOrbit>& found);

/// The sense in which time shifts turn a plane: +1 from its first coordinate to the second, -1 back, 0 if they do not.
[[nodiscard]] int sense_of_time(const KernelActions& group);

}  // namespace orbweaver::bifurcation
