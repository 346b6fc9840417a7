#pragma once

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What orbits with one number of harmonics take: sizes exactly, the others as they were measured (docs/performance.md,
/// "What a scene will cost").
struct OrbitCost {
  int cutoff = 0;
  double unknowns = 0.0;       ///< (2K + 1) d
  double memory_bytes = 0.0;   ///< of a rank that follows a family, the program included
  double working_bytes = 0.0;  ///< those of them that are the orbit's
  double archive_bytes = 0.0;  ///< of an orbit's modes
  double seconds_from = 0.0;   ///< of one orbit, its certificate included
  double seconds_to = 0.0;
};

struct ExpectedWork {
  double sweep_periods = 0.0;  ///< sampled at each equilibrium
  double sweep_seconds = 0.0;  ///< at most, each
  OrbitCost least;             ///< at the scene's least K
  OrbitCost most;              ///< at its greatest, should a family come to need it
};

[[nodiscard]] ExpectedWork expected_work(const scene::Scene& scene, const systems::System& system);

/// Bytes that orbits may take of this process: the machine's memory less the program, or what its limits (`ulimit -v`,
/// `-d`) leave beside core::space_of_a_rank.
[[nodiscard]] double usable_memory();

/// Throws InputError, naming the key, unless an orbit with the scene's least K fits into `memory_bytes`, and
/// EnvironmentError where the limits of this process do not even leave what a rank takes without one.
void require_memory(const ExpectedWork& work);

}  // namespace orbweaver::survey
