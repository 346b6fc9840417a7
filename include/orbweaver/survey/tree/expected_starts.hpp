#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/tree/undeclared.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// An equilibrium that the grid leads to, in the units of the scene.
struct ExpectedEquilibrium {
  std::string text;             ///< where it is
  std::vector<double> periods;  ///< of its small oscillations, longest first
  double energy = 0.0;          ///< NaN where none is conserved
  std::string stability;        ///< of the linearised equilibrium
};

/// Where a survey of a scene would begin.
struct ExpectedStarts {
  std::size_t equilibria = 0;       ///< of them; of a driven system those that rest at every phase of the drive
  std::vector<std::string> orbits;  ///< a line an orbit of another archive: which it is
  std::size_t near_returns = 0;     ///< guesses that would be corrected
  std::vector<ExpectedEquilibrium> resting;  ///< all that the grid leads to; none of a driven system
  Undeclared undeclared;                     ///< as the survey's notes tell it
};

/// Both in the survey's scales (ScaledScene). Looks for the equilibria, opens the archives, follows the trajectory and
/// holds the system against its structure there (systems::require_identities). Throws InputError for whatever a survey
/// is refused for before its first task.
[[nodiscard]] ExpectedStarts expected_starts(const scene::Scene& scene, const systems::System& system);

}  // namespace orbweaver::survey
