#pragma once

#include <vector>

#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::bifurcation {

/// A family of small oscillations, and its place among all of the equilibrium, longest period first, whether or not the
/// range of the sweep includes them: from 0. Families of one period stand in the order of their directions.
struct SmallOscillation {
  starts::NormalMode mode;
  int place = 0;
  bool both_sides = false;  ///< the opposite direction leads to other orbits
  double amplitude = 0.0;   ///< |dz(s = 0)| of the first orbit where it matters: the others of its period have as much;
                            ///< 0: any
};

/// The number of families, or of places, where nothing in the range depends on it: neither is known.
inline constexpr int not_counted = -1;

/// Families with one period that keep their places: outside the range, or not found, for which there is a sentence.
struct LeftOut {
  double period = 0.0;
  int place = 0;  ///< of the first
  /// Or `not_counted`: several oscillations share the period, or do behind those of which that holds.
  int families = 1;
  bool is_told = false;  ///< what their eigenvalues are, or where families leave, is not known, or none leaves
};

/// A family in a kernel of several oscillations.
struct KernelFamily {
  int place = 0;
  int images = 1;       ///< that the system's symmetries make of its small orbits, time shifts aside, and both sides
  int repetitions = 1;  ///< that its orbits go around while the kernel's period passes
};

/// A period that several oscillations share, exactly or nearly, and all families near it.
struct OscillationKernel {
  double period = 0.0;
  int dimension = 0;  ///< complex: oscillations
  bool is_definite = false;
  int not_isolated = 0;  ///< as Directions
  std::vector<KernelFamily> families;
  double detuning = 0.0;  ///< starts::SharedPeriod::detuning
};

struct SmallOscillations {
  std::vector<SmallOscillation> families;           ///< in the range, longest period first
  std::vector<LeftOut> left_out;                    ///< longest period first
  std::vector<OscillationKernel> kernels;           ///< in the range
  std::vector<starts::RejectedDip> without_family;  ///< kernels in the range along which none was found
  int count = 0;                                    ///< of all places, or `not_counted`
};

/// The families of small oscillations at an equilibrium, by a sweep with loops of `cutoff` harmonics: its simple modes,
/// and the directions in the kernels that several oscillations share, less those that go around a shorter period, which
/// has a kernel of its own. A kernel without one keeps a place, or outside the range, where its directions cannot be
/// found, as many as it has dimensions of harmonic 1. Throws as equilibrium_directions does.
[[nodiscard]] SmallOscillations small_oscillations(const systems::System& system, const starts::SweepResult& sweep,
                                                   int cutoff);

}  // namespace orbweaver::bifurcation
