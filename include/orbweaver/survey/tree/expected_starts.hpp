#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Where a survey of a scene would begin.
struct ExpectedStarts {
  std::size_t equilibria = 0;       ///< of them; of a driven system those that rest at every phase of the drive
  std::vector<std::string> orbits;  ///< a line an orbit of another archive: which it is
  std::size_t near_returns = 0;     ///< guesses that would be corrected
};

/// Both in the survey's scales (ScaledScene). Looks for the equilibria, opens the archives, follows the trajectory and
/// holds the system against its structure there (systems::require_identities). Throws InputError for whatever a survey
/// is refused for before its first task.
[[nodiscard]] ExpectedStarts expected_starts(const scene::Scene& scene, const systems::System& system);

}  // namespace orbweaver::survey
