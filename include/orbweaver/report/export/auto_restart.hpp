#pragma once

#include <ostream>
#include <string>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/export/export_orbits.hpp"

namespace orbweaver::report {

/// Periodic solutions in the format in which AUTO-07p restarts (its fort.8, or s.NAME): orbits of one family, in the
/// order of their steps, with the labels 1, 2, ... Each has its mesh (intervals of equal s, so many that the piecewise
/// polynomials of AUTO deviate by less than 1e-6 of a coordinate's range; four points each), the states, the direction
/// of the family there (from the neighbouring orbits; that of the period alone where there are none), and PAR: the
/// period at PAR(11), 0 at PAR(10), the unfolding of a conservative system; the parameters as auto_parameter numbers
/// them, and behind them the conserved quantity. Throws InputError as export_csv, without a family, and for orbits that
/// turn over, which AUTO's boundary conditions do not allow.
void export_auto(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection);

/// The equations file for it, Fortran 90: FUNC, with PAR(10) times the gradient of the conserved quantity added to the
/// field of a conservative system, and PVLS, which gives that quantity. Numerical derivatives (JAC=0) will do. Throws
/// InputError for a system that does not give its formulas, or conserves more than one quantity.
[[nodiscard]] std::string auto_equations(const archive::Archive& atlas);

/// The number in PAR of parameter `index` of the header: 1 to 9, then 13 on; AUTO has the period at 11.
[[nodiscard]] constexpr int auto_parameter(int index) { return index < 9 ? index + 1 : index + 4; }
inline constexpr int auto_unfolding = 10;
inline constexpr int auto_period = 11;

}  // namespace orbweaver::report
