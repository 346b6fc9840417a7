#include "orbweaver/scene/in_scales.hpp"

#include <algorithm>

namespace orbweaver::scene {

systems::Scales scales_of(const Scene& scene, const systems::System& system, const systems::Scales& natural) {
  const auto& given = scene.system.scales;
  if (given.empty()) return natural;
  const auto value = [&](const std::string& name, double otherwise) {
    const auto found = given.find(name);
    return found == given.end() ? otherwise : found->second;
  };
  systems::Scales scales;
  scales.time = value("time", natural.time);
  const std::vector<std::string>& names = system.info().state_names;
  for (std::size_t i = 0; i < names.size(); ++i) scales.coordinates.push_back(value(names[i], natural.coordinate(i)));
  const std::vector<std::string>& quantities = system.structure().conserved;
  for (std::size_t k = 0; k < quantities.size(); ++k)
    scales.conserved.push_back(value(quantities[k], natural.conserved.empty() ? 1.0 : natural.conserved[k]));
  const std::vector<std::string>& free = system.family_scalars().free;
  for (std::size_t n = 0; n < free.size(); ++n) scales.parameters.push_back(value(free[n], natural.parameter(n)));
  return scales;
}

double scale_of_lengths(const systems::System& system, const systems::Scales& scales) {
  if (system.structure().has_angles() || scales.coordinates.empty()) return 1.0;
  return *std::max_element(scales.coordinates.begin(), scales.coordinates.end());
}

Scene in_scales(Scene scene, const systems::System& system, const systems::Scales& scales) {
  if (scales.are_one()) return scene;
  for (std::size_t i = 0; i < scene.fixed_points.grid.size(); ++i)
    for (double& value : scene.fixed_points.grid[i]) value /= scales.coordinate(i);
  for (FixedPoints::Names& named : scene.fixed_points.names)
    for (std::size_t i = 0; i < named.point.size(); ++i) named.point[i] /= scales.coordinate(i);
  if (scene.sweep.period) {
    scene.sweep.period->from /= scales.time;
    scene.sweep.period->to /= scales.time;
    if (!scene.sweep.step) scene.sweep.step = Sweep::standard_step;
  }
  if (scene.sweep.step) *scene.sweep.step /= scales.time;
  const double largest = scale_of_lengths(system, scales);
  if (scene.continuation.fixed_step) *scene.continuation.fixed_step /= largest;
  if (scene.continuation.start_is_given) scene.continuation.start_amplitude /= largest;
  scene.limits.period /= scales.time;
  scene.limits.parameter_from /= scales.parameter(0);
  scene.limits.parameter_to /= scales.parameter(0);
  const auto to_scales = [&](std::vector<double>& state) {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] /= scales.coordinate(i);
  };
  for (StateStart& start : scene.states) {
    to_scales(start.state);
    start.period /= scales.time;
  }
  for (LoopStart& start : scene.loops) {
    for (std::vector<double>& state : start.samples.states) to_scales(state);
    for (double& time : start.samples.times) time /= scales.time;
    start.period /= scales.time;
  }
  if (scene.recurrences) {
    to_scales(scene.recurrences->state);
    for (double* time : {&scene.recurrences->time, &scene.recurrences->period_from, &scene.recurrences->period_to})
      *time /= scales.time;
  }
  scene.limits.energy_from /= scales.energy();
  scene.limits.energy_to /= scales.energy();
  for (double& period : scene.events.periods) period /= scales.time;
  for (double& energy : scene.events.energies) energy /= scales.energy();
  const std::vector<std::string>& names = system.info().state_names;
  const auto place = std::find(names.begin(), names.end(), scene.section.coordinate);
  if (place != names.end()) scene.section.value /= scales.coordinate(static_cast<std::size_t>(place - names.begin()));
  return scene;
}

}  // namespace orbweaver::scene
