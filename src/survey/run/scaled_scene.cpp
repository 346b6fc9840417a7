#include "orbweaver/survey/run/scaled_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/in_scales.hpp"
#include "orbweaver/starts/natural_scales.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::survey {

ScaledScene::ScaledScene(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system)
    : _system(systems::scaled(
          system, scene::scales_of(scene, *system, starts::natural_scales(*system, scene.fixed_points.grid)))),
      _scene(scene::in_scales(scene, *_system, _system->scales())) {}

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
