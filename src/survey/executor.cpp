#include "executor.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/continuation/sweep.hpp"
#include "orbweaver/core/error.hpp"
#include "small_oscillations.hpp"
#include "stability_columns.hpp"

namespace orbweaver::survey {

namespace {

// Both directions of a start are one family where a symmetry or a time shift maps loops on one side to those on the other.
bool directions_are_images(const systems::Description& system, std::span<const double> point,
                           const continuation::NormalMode& mode, int cutoff) {
  loop::Loop plus = loop::constant_loop(point, mode.period, cutoff);
  loop::Loop minus = plus;
  for (std::size_t n = 0; n < plus.modes.size(); ++n) {
    plus.modes[n] += mode.direction[n];
    minus.modes[n] -= mode.direction[n];
  }
  return loop::find_map(system, plus, minus, 1e-8).has_value();
}

}  // namespace

continuation::Options branch_options(const scene::Scene& scene) {
  continuation::Options options;
  options.corrector.method = corrector::method_of(scene.continuation.corrector);
  options.corrector.tolerance = scene.continuation.tolerance;
  options.cutoff_from = scene.continuation.cutoff_from;
  options.cutoff_to = scene.continuation.cutoff_to;
  options.fixed_step = scene.continuation.fixed_step;
  options.start_amplitude = scene.continuation.start_amplitude;
  options.period_limit = scene.limits.period;
  options.energy_from = scene.limits.energy_from;
  options.energy_to = scene.limits.energy_to;
  options.step_limit = scene.limits.steps;
  options.off_branch_spectrum = scene.survey.spectrum == scene::Spectrum::all;
  return options;
}

Executor::Executor(const scene::Scene& scene, std::shared_ptr<const systems::System> system, archive::Records& rows)
    : _scene(scene), _system(std::move(system)), _rows(rows) {}

queue::TaskOutcome Executor::execute(const queue::Task& task, queue::TaskContext& context) {
  if (task.kind == sweep_kind) return sweep(unpack_sweep_work(task.payload));
  if (task.kind == branch_kind) return follow(unpack_branch_work(task.payload), context);
  throw core::EnvironmentError(fmt::format("no such kind of task: `{}`", task.kind));
}

queue::TaskOutcome Executor::sweep(const SweepWork& work) const {
  continuation::SweepOptions options;
  options.period_from = _scene.sweep.period_from;
  options.period_to = _scene.sweep.period_to;
  options.step = _scene.sweep.step;
  const continuation::SweepResult result = continuation::sweep(*_system, work.point, options);
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  for (const continuation::NormalMode& mode : small_oscillations(*_system, result, options.cutoff)) {
    FoundMode found;
    found.period = mode.period;
    found.direction = mode.direction;
    found.cutoff = options.cutoff;
    found.one_direction = directions_are_images(_system->description(), work.point, mode, options.cutoff);
    set_isotropy(found, mode.isotropy);
    outcome.modes.push_back(std::move(found));
  }
  for (const continuation::RejectedDip& dip : result.rejected)
    outcome.rejected.push_back(fmt::format("T = {:.9g}: {}", dip.period, dip.reason));
  queue::TaskOutcome done;
  done.payload = pack(outcome);
  return done;
}

queue::TaskOutcome Executor::follow(const BranchWork& work, queue::TaskContext& context) {
  BranchOutcome outcome;
  outcome.key = work.key;
  continuation::Start start;
  const auto keep = [&](const continuation::Orbit& orbit) {
    _rows.orbits.push_back(record(work.key, orbit, start.isotropy));
    const bool first = outcome.orbits == 0;
    outcome.period_from = first ? orbit.loop.period : std::min(outcome.period_from, orbit.loop.period);
    outcome.period_to = first ? orbit.loop.period : std::max(outcome.period_to, orbit.loop.period);
    outcome.energy_from = first ? orbit.energy : std::min(outcome.energy_from, orbit.energy);
    outcome.energy_to = first ? orbit.energy : std::max(outcome.energy_to, orbit.energy);
    outcome.last_period = orbit.loop.period;
    outcome.last_energy = orbit.energy;
    outcome.last_cutoff = orbit.loop.cutoff;
    ++outcome.orbits;
    return context.report(
        {orbit.step + 1, 1, {orbit.loop.period, orbit.energy, static_cast<double>(orbit.loop.cutoff)}});
  };
  continuation::Ending ending;
  try {
    start = start_of(work, _system->description());
    ending = continuation::trace(_system, start, branch_options(_scene), keep);
  } catch (
      const std::exception& error) {  // caught here, not by the queue, so that the summary still counts the orbits kept
    ending = {continuation::EndReason::failure, error.what()};
  }
  outcome.end_reason = ending.text();
  queue::TaskOutcome done;
  done.failed = ending.failed();
  done.reason = ending.failed() ? outcome.end_reason : "";
  done.payload = pack(outcome);
  return done;
}

archive::OrbitRecord Executor::record(const std::string& key, const continuation::Orbit& orbit,
                                      const loop::Isotropy& isotropy) const {
  archive::OrbitRecord row;
  row.family_key = key;
  row.step = orbit.step;
  row.arclength = orbit.arclength;
  row.period = orbit.loop.period;
  row.energy = orbit.energy;
  row.action = orbit.action;
  row.cutoff = orbit.loop.cutoff;
  row.loss_rms = orbit.loss_rms;
  row.off_branch_eigenvalue = orbit.off_branch_eigenvalue;
  row.tail = orbit.tail;
  row.state = loop::state_at(orbit.loop, 0.0);
  row.modes = orbit.loop.modes;
  row.time_map = loop::to_numbers(orbit.loop.time_map);
  const systems::Description& system = _system->description();
  for (const int angle : system.angles) row.winding.push_back(orbit.loop.winding[static_cast<std::size_t>(angle)]);
  set_stability(*_system, orbit.loop, isotropy, row);
  const certificate::Certificate certificate = certificate::certify(*_system, orbit.loop);
  row.closure = certificate.closure;
  row.single_shot = certificate.single_shot;
  row.energy_drift = certificate.energy_drift;
  return row;
}

}  // namespace orbweaver::survey
