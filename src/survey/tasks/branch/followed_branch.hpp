#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Known orbits that a location gets along: the two around the event and their neighbours.
inline constexpr std::size_t kept_orbits = 5;

/// A branch as it is followed: what it is, and what is known of it so far. The parts of its task share it.
class FollowedBranch {
 public:
  FollowedBranch(const scene::Scene& scene, std::shared_ptr<const systems::System> system, BranchWork work,
                 core::Team* team);

  /// Of any loop of the family; none where the scene asks for no multipliers.
  [[nodiscard]] std::optional<spectrum::Stability> asked_stability(const loop::Loop& loop) const;
  /// Not computed again for the orbit that was asked for last.
  const std::optional<spectrum::Stability>& stability_at(const continuation::Orbit& orbit);
  [[nodiscard]] bifurcation::TestPoint test_point(double position,
                                                  const std::optional<spectrum::Stability>& stability) const;

  const scene::Scene& scene;
  std::shared_ptr<const systems::System> system;
  BranchWork work;
  core::Team* team;  ///< divides the work of the task; may be null
  continuation::Start start;
  continuation::FamilyCurve curve;                   ///< of its last orbits
  std::vector<bifurcation::TestFunction> functions;  ///< none where the scene asks for no multipliers
  std::optional<continuation::Orbit> last;
  BranchOutcome outcome;

 private:
  std::optional<loop::Loop> _asked;               // the orbit whose stability was asked for last,
  std::optional<spectrum::Stability> _stability;  // and its stability
};

}  // namespace orbweaver::survey
