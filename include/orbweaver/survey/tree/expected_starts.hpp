#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What a scene gives beside its equilibria.
struct ExpectedStarts {
  std::vector<std::string> orbits;  ///< a line an orbit of another archive: which it is
  std::size_t near_returns = 0;     ///< guesses that would be corrected
};

/// Both in the survey's scales (ScaledScene). Opens the archives and follows the trajectory. Throws InputError as a
/// survey would.
[[nodiscard]] ExpectedStarts expected_starts(const scene::Scene& scene, const systems::System& system);

}  // namespace orbweaver::survey
