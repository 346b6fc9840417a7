#include "task_kind.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::survey {

const char* name_of(TaskKind kind) {
  switch (kind) {
    case TaskKind::sweep: return "sweep";
    case TaskKind::branch: return "branch";
    case TaskKind::locate: return "locate";
    case TaskKind::start: return "start";
    case TaskKind::locus: return "locus";
  }
  return "unknown";
}

TaskKind kind_of(const queue::Task& task) {
  for (const TaskKind kind : {TaskKind::sweep, TaskKind::branch, TaskKind::locate, TaskKind::start, TaskKind::locus})
    if (task.kind == name_of(kind)) return kind;
  throw core::EnvironmentError(fmt::format("no such kind of task: `{}`", core::printable(task.kind)));
}

int priority_of(TaskKind kind, int depth) {
  constexpr int kinds_a_depth = 3;
  switch (kind) {
    case TaskKind::sweep: return 0;
    case TaskKind::branch: return 1 + kinds_a_depth * depth;
    case TaskKind::locate: return 2 + kinds_a_depth * depth;
    case TaskKind::start:
    case TaskKind::locus: return 3 + kinds_a_depth * depth;
  }
  return 0;
}

void check_limits(int limits) {
  constexpr int all = orbit_limited | step_limited | depth_limited | order_limited;
  if ((limits & ~all) != 0)
    throw core::EnvironmentError(
        fmt::format("an outcome names the limits {:#x}, of which {:#x} are known", limits, all));
}

}  // namespace orbweaver::survey
