#include "executor.hpp"

#include <utility>

#include <fmt/format.h>

#include "tasks/branch/branch_task.hpp"
#include "equilibrium_places.hpp"
#include "given_start.hpp"
#include "locate_task.hpp"
#include "locus_task.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/survey/tasks/sweep_options.hpp"
#include "parameter_starts.hpp"
#include "start_task.hpp"

namespace orbweaver::survey {

Executor::Executor(const scene::Scene& scene, std::shared_ptr<const systems::System> system, archive::Records& rows,
                   core::Team* team, PayloadStore* store)
    : _scene(scene), _system(std::move(system)), _rows(rows), _team(team), _store(team == nullptr ? store : nullptr) {}

queue::TaskOutcome Executor::execute(const queue::Task& task, queue::TaskContext& context) {
  _orbits_before = _rows.orbits.size();
  _sections_before = _rows.sections.size();
  switch (kind_of(task)) {
    case TaskKind::sweep: return sweep(unpack_sweep_work(task.payload));
    case TaskKind::branch:
      return BranchTask(_scene, _system, unpack_branch_work(task.payload), task.state, _given, _rows, context, _team,
                        _store)
          .run();
    case TaskKind::locate: return locate(_scene, _system, unpack_locate_work(task.payload), context, _team);
    case TaskKind::locus: return follow_locus(_scene, *_system, unpack_locus_work(task.payload), context, _team);
    case TaskKind::start: return start(_scene, _system, unpack_start_work(task.payload), _team);
  }
  throw core::MisuseError("a task of a kind that is none");
}

void Executor::take_back_rows(bool flushed) {
  _rows.orbits.resize(flushed ? 0 : _orbits_before);
  _rows.sections.resize(flushed ? 0 : _sections_before);
}

queue::TaskOutcome Executor::sweep(const SweepWork& work) const {
  queue::TaskOutcome done;
  if (!work.given.empty())
    done.payload = pack(given_start(_scene, _system, work, _team));
  else if (_system->family_scalars().free.empty())
    done.payload = pack(small_oscillations(work));
  else if (_system->structure().driven)
    done.payload = pack(drive_start(_scene, *_system, work));
  else if (!_system->structure().conservative())
    done.payload = pack(hopf_starts(_scene, *_system, work));
  return done;
}

SweepOutcome Executor::small_oscillations(const SweepWork& work) const {
  const starts::SweepOptions options = sweep_options(_scene, *_system, work.point);
  const starts::SweepResult result = starts::sweep(*_system, work.point, options);
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  outcome.period_from = options.period_from;
  outcome.period_to = options.period_to;
  const bifurcation::SmallOscillations all = bifurcation::small_oscillations(*_system, result, options.cutoff);
  outcome.families = all.count;
  outcome.equilibria = {equilibrium_place(*_system, work.point, result.linear)};
  for (const bifurcation::LeftOut& left_out : all.left_out)
    if (!left_out.is_told)  // those are among the ones without a family
      outcome.left_out.push_back({left_out.period, left_out.place, left_out.families});
  for (const bifurcation::SmallOscillation& family : all.families) {
    FoundMode found;
    found.place = family.place;
    found.period = family.mode.period;
    found.direction = family.mode.direction;
    found.cutoff = (static_cast<int>(found.direction.modes.size() / work.point.size()) - 1) / 2;
    found.one_direction = !family.both_sides;
    found.isotropy = family.mode.isotropy;
    found.amplitude = family.amplitude;
    outcome.modes.push_back(std::move(found));
  }
  for (const bifurcation::OscillationKernel& kernel : all.kernels) {
    KernelRecord record;
    record.period = kernel.period;
    record.dimension = kernel.dimension;
    record.is_definite = kernel.is_definite;
    record.not_isolated = kernel.not_isolated;
    record.detuning = kernel.detuning;
    for (const bifurcation::KernelFamily& family : kernel.families) {
      record.places.push_back(family.place);
      record.images.push_back(family.images);
      record.repetitions.push_back(family.repetitions);
    }
    outcome.kernels.push_back(std::move(record));
  }
  const auto sentence = [&](const starts::RejectedDip& dip) {
    return fmt::format("T = {:.9g}: {}", dip.period * _system->scales().time, dip.reason);
  };
  for (const starts::RejectedDip& dip : result.rejected) outcome.rejected.push_back(sentence(dip));
  for (const starts::RejectedDip& dip : all.without_family) outcome.without_family.push_back(sentence(dip));
  return outcome;
}

}  // namespace orbweaver::survey
