#pragma once

#include <vector>

#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::bifurcation {

/// A family of small oscillations, and its place among all of the equilibrium, longest period first, whether or not the
/// range of the sweep includes them: from 0. Families of one period stand in the order of their directions.
struct SmallOscillation {
  starts::NormalMode mode;
  int place = 0;
};

/// Families with one period that keep their places: outside the range, or perhaps families, as rounding does not tell
/// what their eigenvalues are.
struct LeftOut {
  double period = 0.0;
  int place = 0;  ///< of the first
  int families = 1;
  bool undecided = false;
};

struct SmallOscillations {
  std::vector<SmallOscillation> families;  ///< in the range, longest period first
  std::vector<LeftOut> left_out;           ///< longest period first
  int count = 0;                           ///< of all places
};

/// The families of small oscillations at an equilibrium, by a sweep with loops of `cutoff` harmonics: its simple modes,
/// and the directions in the kernels that several oscillations share. A kernel outside the range of which no direction
/// is found counts as many families as it has dimensions. Throws as equilibrium_directions does.
[[nodiscard]] SmallOscillations small_oscillations(const systems::System& system, const starts::SweepResult& sweep,
                                                   int cutoff);

}  // namespace orbweaver::bifurcation
