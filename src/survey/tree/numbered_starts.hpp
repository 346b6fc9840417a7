#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/sweep_work.hpp"

namespace orbweaver::survey {

/// What became of an orbit that the scene gives.
struct FoundStart {
  GivenStart given;
  SweepOutcome outcome;
};

/// A family that begins at an orbit that the scene gives.
struct NumberedStart {
  std::string name;
  std::string told;  ///< GivenStart::told
  int number = 0;    ///< among them
  FoundMode mode;
};

/// The families of the orbits found, each orbit once (bifurcation::same_orbit; the first that gives it stays), with
/// numbers in the order of winding, period and level, whatever the order of the scene; of returns as many as the scene
/// keeps, the shortest periods first. The scene's names, else what the first orbit is: "Orbit n(0,1) T=6.28319 E=0.5".
/// Says what is left out in `remarks`.
[[nodiscard]] std::vector<NumberedStart> numbered_starts(const scene::Scene& scene, const systems::System& system,
                                                         std::vector<FoundStart> found,
                                                         std::vector<std::string>& remarks);

}  // namespace orbweaver::survey
