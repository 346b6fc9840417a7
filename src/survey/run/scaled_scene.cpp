#include "orbweaver/survey/run/scaled_scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/in_scales.hpp"
#include "orbweaver/starts/natural_scales.hpp"
#include "orbweaver/starts/near_returns.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::survey {

namespace {

/// Of each further quantity two multipliers would be 1 along all families, and look like events.
void require_one_quantity(const systems::System& system) {
  const std::vector<std::string>& conserved = system.structure().conserved;
  if (conserved.size() > 1)
    throw core::InputError(
        fmt::format("expected a system that conserves one quantity, got {} with {}; others than the energy are taken "
                    "out where they are linear in the coordinates, but {}: choose coordinates in which they are, "
                    "polar ones for an angular momentum, or take them out of the equations "
                    "(docs/your_own_system.md, \"More conserved quantities\")",
                    system.info().name, fmt::join(conserved, ", "), systems::why_not_reduced(system)));
}

/// The power of two at or below the largest of its value and its finite limits; 1 where all are 0.
double scale_of_parameter(double value, const scene::Limits& limits) {
  double largest = std::abs(value);
  for (const double limit : {limits.parameter_from, limits.parameter_to})
    if (std::isfinite(limit)) largest = std::max(largest, std::abs(limit));
  return largest > 0.0 ? std::exp2(std::floor(std::log2(largest))) : 1.0;
}

/// Orbits that no conserved quantity and no reversor holds are isolated. A system that has reversors and says no more
/// may be a reversible one, with families in the period.
void require_families(const systems::System& system) {
  const systems::Structure& structure = system.structure();
  if (structure.decays)
    throw core::InputError(fmt::format(
        "expected a system that has families of periodic orbits, got {}: damped and without a drive, all its motions "
        "come to rest; add an effect that drives it, or leave out the damping (orbweaver systems lists the effects)",
        system.info().title));
  const bool isolated =
      !structure.conservative() && (structure.dissipative || structure.driven || structure.reversors.empty());
  if (isolated && system.family_scalars().free.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, value] : system.parameters()) names.push_back(name);
    throw core::InputError(fmt::format(
        "expected `continuation: {{free: ...}}`, the parameter that moves along the families of {}, which conserves "
        "nothing: {}{}",
        system.info().title, names.empty() ? "the model wants one" : fmt::format("one of {}", fmt::join(names, ", ")),
        structure.dissipative || structure.driven
            ? ""
            : "; if it keeps an energy, name that in the model's structure.conserved and give conserved<0>"));
  }
}

std::shared_ptr<const systems::System> in_own_scales(const scene::Scene& scene,
                                                     const std::shared_ptr<const systems::System>& system) {
  require_one_quantity(*system);
  require_families(*system);
  systems::Scales natural = starts::natural_scales(*system, scene.fixed_points.grid);
  if (natural.coordinates.empty() && scene.recurrences) {
    const scene::Recurrences& given = *scene.recurrences;
    natural = starts::trajectory_scales(*system, given.state,
                                        {given.time, given.period_from, given.period_to, given.tolerance});
  }
  for (const std::string& name : system->family_scalars().free)
    natural.parameters.push_back(scale_of_parameter(system->parameters().at(name), scene.limits));
  return systems::scaled(system, scene::scales_of(scene, *system, natural));
}

}  // namespace

ScaledScene::ScaledScene(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system)
    : _system(in_own_scales(scene, system)), _scene(scene::in_scales(scene, *_system, _system->scales())) {}

void ScaledScene::expect(const systems::Scales& scales) const {
  const systems::Scales& here = _system->scales();
  if (scales == here || (scales.are_one() && here.are_one())) return;
  const auto text = [](const systems::Scales& s) {
    return fmt::format("time {:g}, coordinates [{:g}]", s.time, fmt::join(s.coordinates, ", "));
  };
  throw core::InputError(fmt::format(
      "the survey was begun with the scales {}, and they would be {} now: go on with the program that began "
      "it, or give another folder with -o",
      text(scales), text(here)));
}

}  // namespace orbweaver::survey
