#include "orbweaver/survey/tasks/sweep_options.hpp"

#include <algorithm>

namespace orbweaver::survey {

starts::SweepOptions sweep_options(const scene::Scene& scene, const systems::System& system,
                                   std::span<const double> point) {
  const scene::Sweep& sweep = scene.sweep;
  starts::SweepOptions options;
  if (sweep.period) {
    options.period_from = sweep.period->from;
    options.period_to = sweep.period->to;
    options.step = scene::Sweep::standard_step;
  } else {
    options = starts::automatic_range(starts::linear_modes(system, point));
  }
  // What the scene's reader sees to where it knows the range.
  if (sweep.step)
    options.step = std::max(*sweep.step, (options.period_to - options.period_from) / scene::Sweep::most_steps);
  options.amplitude = scene.continuation.start_amplitude;
  return options;
}

}  // namespace orbweaver::survey
