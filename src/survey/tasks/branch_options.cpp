#include "orbweaver/survey/tasks/branch_options.hpp"

#include "orbweaver/corrector/method.hpp"

namespace orbweaver::survey {

continuation::Options branch_options(const scene::Scene& scene, core::Team* team) {
  continuation::Options options;
  options.corrector.method = corrector::method_of(scene.continuation.corrector);
  options.corrector.tolerance = scene.continuation.tolerance;
  options.corrector.team = team;
  options.cutoff_from = scene.continuation.cutoff_from;
  options.cutoff_to = scene.continuation.cutoff_to;
  options.fixed_step = scene.continuation.fixed_step;
  options.start_amplitude = scene.continuation.start_amplitude;
  options.period_limit = scene.limits.period;
  options.energy_from = scene.limits.energy_from;
  options.energy_to = scene.limits.energy_to;
  options.parameter_from = scene.limits.parameter_from;
  options.parameter_to = scene.limits.parameter_to;
  options.guard_limits = scene.limits.guards;
  options.step_limit = scene.limits.steps;
  options.off_branch_spectrum = scene.survey.spectrum == scene::Spectrum::all;
  return options;
}

}  // namespace orbweaver::survey
