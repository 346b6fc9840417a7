#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// A period and all oscillations of which it is a whole number of periods, 1 to `strongest_harmonic`, exactly or
/// nearly: the kernel of the constant loop with that period. Families of small amplitude start along combinations of
/// its vectors Re(v e^{iks}).
struct SharedPeriod {
  struct Member {
    std::size_t oscillation = 0;  ///< index into LinearModes::oscillations
    int harmonic = 1;             ///< k: goes around so many times
  };

  double period = 0.0;          ///< the longest of the oscillations of harmonic 1
  double residual = 0.0;        ///< the largest of their residuals
  std::vector<Member> members;  ///< by harmonic, then as in LinearModes; the first has harmonic 1
  Eigen::MatrixXcd kernel;      ///< a vector v a column; those of one harmonic are orthonormal
  std::vector<int> harmonics;   ///< k of each column
  /// The energy of all combinations has one sign to second order: its level sets are spheres. False where the system
  /// conserves nothing.
  bool is_definite = false;
  /// Length in the kernel (in scales) up to which nearly shared periods are apart: its families start no further out.
  double apart_below = std::numeric_limits<double>::infinity();
  /// Length in the kernel at which its families start at least: those nearer to the equilibrium are not told apart.
  double together_from = 0.0;
  /// The largest of its members' detunings that count as none, in parts of the period; 0: rounding.
  double detuning = 0.0;

  /// One oscillation, which shares its period with no other.
  [[nodiscard]] bool is_simple() const { return kernel.cols() == 1; }
};

/// Up to this harmonic a resonance has terms of the fourth order or less, which decide where small orbits lie together
/// with those that every oscillation has. Beyond it they decide nothing but phases, and every oscillation's own family
/// is there (docs/mathematics.md, "Resonances").
inline constexpr int strongest_harmonic = 3;

/// Each oscillation is of harmonic 1 in exactly one of them, longest period first. Orbits of length r in the kernel (in
/// scales) do not tell a detuning from none that is, in parts of the period, below 5 r (k = 2) or 5 r^2 (k = 1, 3), and
/// 0.05 at most. Those that are told at `amplitude`, or at a smaller one down to 2e-4, are apart (`apart_below`), the
/// others share a period. Throws MisuseError for a point of another dimension.
[[nodiscard]] std::vector<SharedPeriod> shared_periods(const systems::System& system, std::span<const double> point,
                                                       const LinearModes& modes, double amplitude);

}  // namespace orbweaver::starts
