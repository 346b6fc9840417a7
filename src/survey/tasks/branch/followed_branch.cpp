#include "followed_branch.hpp"

#include <utility>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/orbit_row.hpp"

namespace orbweaver::survey {

namespace {

/// None where the scene asks for no multipliers.
std::vector<bifurcation::TestFunction> functions_of(const scene::Scene& scene, const systems::System& system,
                                                    const loop::Isotropy& isotropy) {
  if (!scene.compute.stability) return {};
  return bifurcation::test_functions(system.structure(), loop::SymmetryGroup(system.structure(), isotropy).order(),
                                     scene.survey.subharmonics);
}

}  // namespace

FollowedBranch::FollowedBranch(const scene::Scene& scene_of_all, std::shared_ptr<const systems::System> system_of_all,
                               BranchWork work_to_do, core::Team* team_of_task)
    : scene(scene_of_all),
      system(std::move(system_of_all)),
      work(std::move(work_to_do)),
      team(team_of_task),
      start(start_of(work, system->structure())),
      curve(system, start.isotropy, branch_options(scene, team)),
      functions(functions_of(scene, *system, start.isotropy)) {
  outcome.key = work.key;
}

std::optional<spectrum::Stability> FollowedBranch::asked_stability(const loop::Loop& loop) const {
  if (!scene.compute.stability) return std::nullopt;
  return stability_of(*system, loop, start.isotropy, team);
}

const std::optional<spectrum::Stability>& FollowedBranch::stability_at(const continuation::Orbit& orbit) {
  // Where all but the phase of a drive rests only the parameter tells orbits apart.
  const bool is_asked = _asked && _asked->modes == orbit.loop.modes && _asked->period == orbit.loop.period &&
                        _asked->parameters == orbit.loop.parameters;
  if (!is_asked) {
    _stability = asked_stability(orbit.loop);
    _asked = orbit.loop;
  }
  return _stability;
}

bifurcation::TestPoint FollowedBranch::test_point(double position,
                                                  const std::optional<spectrum::Stability>& stability) const {
  bifurcation::TestPoint out{position, {}};
  const bool decided = stability && bifurcation::are_decided(*stability);
  for (const bifurcation::TestFunction& function : functions) {
    out.readings.push_back(decided ? bifurcation::evaluate(function, system->structure(), *stability)
                                   : bifurcation::Reading{archive::not_computed, archive::not_computed});
    out.passed.push_back(decided ? bifurcation::zeros_passed(function, system->structure(), *stability)
                                 : bifurcation::ZerosPassed{});
  }
  if (decided && bifurcation::is_elliptic(*stability)) out.turns = stability->turns;
  return out;
}

}  // namespace orbweaver::survey
