#include "executor.hpp"

#include <utility>

#include <fmt/format.h>

#include "branch_task.hpp"
#include "locate_task.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/survey/tasks/sweep_options.hpp"
#include "start_task.hpp"

namespace orbweaver::survey {

namespace {

/// How far images of oscillations of unit amplitude may be apart: linear, they agree to rounding, or by some 1 not.
constexpr double same_oscillation = 1e-8;

// Both directions of a start are one family where a symmetry or a time shift maps loops on one side to those on the
// other.
bool directions_are_images(const systems::Structure& system, std::span<const double> point,
                           const starts::NormalMode& mode, int cutoff) {
  const loop::Loop base = loop::constant_loop(point, mode.period, cutoff);
  return loop::find_map(system, loop::moved(base, mode.direction, 1.0), loop::moved(base, mode.direction, -1.0),
                        same_oscillation)
      .has_value();
}

}  // namespace

Executor::Executor(const scene::Scene& scene, std::shared_ptr<const systems::System> system, archive::Records& rows,
                   core::Team* team)
    : _scene(scene), _system(std::move(system)), _rows(rows), _team(team) {}

queue::TaskOutcome Executor::execute(const queue::Task& task, queue::TaskContext& context) {
  switch (kind_of(task)) {
    case TaskKind::sweep: return sweep(unpack_sweep_work(task.payload));
    case TaskKind::branch:
      return BranchTask(_scene, _system, unpack_branch_work(task.payload), task.state, _rows, context, _team).run();
    case TaskKind::locate: return locate(_scene, _system, unpack_locate_work(task.payload), context, _team);
    case TaskKind::start: return start(_scene, _system, unpack_start_work(task.payload), _team);
  }
  throw core::MisuseError("a task of a kind that is none");
}

queue::TaskOutcome Executor::sweep(const SweepWork& work) const {
  const starts::SweepOptions options = sweep_options(_scene.sweep, *_system, work.point);
  const starts::SweepResult result = starts::sweep(*_system, work.point, options);
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  outcome.period_from = options.period_from;
  outcome.period_to = options.period_to;
  const bifurcation::SmallOscillations all = bifurcation::small_oscillations(*_system, result, options.cutoff);
  outcome.families = all.count;
  for (const bifurcation::LeftOut& left_out : all.left_out)
    if (!left_out.undecided)  // those are among the rejected
      outcome.left_out.push_back({left_out.period, left_out.place, left_out.families});
  for (const auto& [mode, place] : all.families) {
    FoundMode found;
    found.place = place;
    found.period = mode.period;
    found.direction = mode.direction;
    found.cutoff = options.cutoff;
    found.one_direction = directions_are_images(_system->structure(), work.point, mode, options.cutoff);
    found.isotropy = mode.isotropy;
    outcome.modes.push_back(std::move(found));
  }
  for (const starts::RejectedDip& dip : result.rejected)
    outcome.rejected.push_back(fmt::format("T = {:.9g}: {}", dip.period * _system->scales().time, dip.reason));
  queue::TaskOutcome done;
  done.payload = pack(outcome);
  return done;
}

}  // namespace orbweaver::survey
