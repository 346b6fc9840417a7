#include "orbweaver/survey/tasks/work.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/time_map.hpp"
#include "orbweaver/survey/tasks/keys.hpp"
#include "payload.hpp"
#include "work_serialization.hpp"

namespace orbweaver::survey {

namespace {

// Within one depth: branches, then what they crossed, then what leaves there.
constexpr int kinds_a_depth = 3;
int priority_of(int depth, int kind) { return 1 + kinds_a_depth * depth + kind; }

const Eigen::MatrixXd& declared_matrix(const systems::Description& system, const std::string& name, bool reversing) {
  for (const systems::Symmetry& s : reversing ? system.reversors : system.equivariances)
    if (s.name == name) return s.matrix;
  throw core::EnvironmentError(
      fmt::format("a task names the symmetry `{}`, which {} does not declare", name, system.name));
}

}  // namespace

LoopRecord record_of(const loop::Loop& loop) {
  return {loop.dimension, loop.cutoff, loop.period, loop.modes, loop.winding, loop::to_numbers(loop.time_map)};
}

loop::Loop loop_of(const LoopRecord& record) {
  loop::Loop loop;
  loop.dimension = record.dimension;
  loop.cutoff = record.cutoff;
  loop.period = record.period;
  loop.modes = record.modes;
  loop.winding = record.winding;
  loop.time_map = loop::time_map_of(record.time_map);
  return loop;
}

IsotropyRecord record_of(const loop::Isotropy& isotropy) {
  IsotropyRecord record;
  for (const loop::SymmetryElement& g : isotropy) {
    record.names.push_back(g.name);
    record.reversing.push_back(g.reversing ? 1 : 0);
    record.shift_numerators.push_back(g.shift_numerator);
    record.shift_denominators.push_back(g.shift_denominator);
  }
  return record;
}

loop::Isotropy isotropy_of(const IsotropyRecord& record, const systems::Description& system) {
  loop::Isotropy isotropy;
  for (std::size_t n = 0; n < record.names.size(); ++n) {
    const bool reversing = record.reversing.at(n) != 0;
    isotropy.push_back({record.names[n], reversing, declared_matrix(system, record.names[n], reversing),
                        record.shift_numerators.at(n), record.shift_denominators.at(n)});
  }
  return isotropy;
}

void set_event(LocateWork& work, const bifurcation::Event& event) {
  work.event = static_cast<int>(event.kind);
  work.function = static_cast<int>(event.function.kind);
  work.q = event.function.sector.q;
  work.j = event.function.sector.j;
  work.tangency = event.tangency;
}

bifurcation::Event event_of(const LocateWork& work) {
  bifurcation::Event event;
  event.kind = static_cast<bifurcation::Event::Kind>(work.event);
  event.function.kind = static_cast<bifurcation::TestFunction::Kind>(work.function);
  event.function.sector = {work.q, work.j};
  event.tangency = work.tangency;
  return event;
}

double signed_arclength(const Lineage& lineage, double before_first, double position) {
  return lineage.side > 0 ? position : -2.0 * before_first - position;
}

const char* name_of(TaskKind kind) {
  switch (kind) {
    case TaskKind::sweep: return "sweep";
    case TaskKind::branch: return "branch";
    case TaskKind::locate: return "locate";
    case TaskKind::start: return "start";
  }
  return "unknown";
}

TaskKind kind_of(const queue::Task& task) {
  for (const TaskKind kind : {TaskKind::sweep, TaskKind::branch, TaskKind::locate, TaskKind::start})
    if (task.kind == name_of(kind)) return kind;
  throw core::EnvironmentError(fmt::format("no such kind of task: `{}`", task.kind));
}

queue::Task task_of(const SweepWork& work) {
  return {fmt::format("sweep.{:04}", work.index), 0, name_of(TaskKind::sweep), pack(work)};
}
queue::Task task_of(const BranchWork& work) {
  return {work.key, priority_of(work.lineage.depth, 0), name_of(TaskKind::branch), pack(work)};
}
queue::Task task_of(const LocateWork& work) {
  return {locate_key(work.key), priority_of(work.lineage.depth, 1), name_of(TaskKind::locate), pack(work)};
}
queue::Task task_of(const StartWork& work) {
  return {start_key(work.branch.key), priority_of(work.branch.lineage.depth - 1, 2), name_of(TaskKind::start),
          pack(work)};
}

std::string pack(const SweepWork& work) { return to_payload(work); }
std::string pack(const SweepOutcome& outcome) { return to_payload(outcome); }
std::string pack(const BranchWork& work) { return to_payload(work); }
std::string pack(const BranchOutcome& outcome) { return to_payload(outcome); }
std::string pack(const LocateWork& work) { return to_payload(work); }
std::string pack(const LocateOutcome& outcome) { return to_payload(outcome); }
std::string pack(const StartWork& work) { return to_payload(work); }
std::string pack(const StartOutcome& outcome) { return to_payload(outcome); }
SweepWork unpack_sweep_work(const std::string& bytes) { return from_payload<SweepWork>(bytes); }
SweepOutcome unpack_sweep_outcome(const std::string& bytes) { return from_payload<SweepOutcome>(bytes); }
BranchWork unpack_branch_work(const std::string& bytes) { return from_payload<BranchWork>(bytes); }
BranchOutcome unpack_branch_outcome(const std::string& bytes) { return from_payload<BranchOutcome>(bytes); }
LocateWork unpack_locate_work(const std::string& bytes) { return from_payload<LocateWork>(bytes); }
LocateOutcome unpack_locate_outcome(const std::string& bytes) { return from_payload<LocateOutcome>(bytes); }
StartWork unpack_start_work(const std::string& bytes) { return from_payload<StartWork>(bytes); }
StartOutcome unpack_start_outcome(const std::string& bytes) { return from_payload<StartOutcome>(bytes); }

continuation::Start start_of(const BranchWork& work, const systems::Description& system) {
  continuation::Start start;
  start.base = loop_of(work.base);
  start.direction = work.direction;
  start.direction *= work.lineage.side;
  start.isotropy = isotropy_of(work.isotropy, system);
  return start;
}

}  // namespace orbweaver::survey
