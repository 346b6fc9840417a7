#pragma once

#include "orbweaver/queue/task.hpp"

namespace orbweaver::survey {

/// What a task is to do.
enum class TaskKind { sweep, branch, locate, start, locus };
/// As in queue::Task::kind.
[[nodiscard]] const char* name_of(TaskKind kind);
/// Throws EnvironmentError for a task that is none of ours.
[[nodiscard]] TaskKind kind_of(const queue::Task& task);

/// Limits of the scene that an outcome may rest on, as bits: with a wider one the task is done again.
enum Limit : int {
  period_limited = 1,
  energy_limited = 2,
  step_limited = 4,
  depth_limited = 8,
  guard_limited = 16,
  order_limited = 32,
  parameter_limited = 64
};
/// Those beyond which single orbits may lie: a step that passes one may have passed the others as well.
inline constexpr int orbit_limited = period_limited | energy_limited | guard_limited | parameter_limited;
/// Throws EnvironmentError for other bits.
void check_limits(int limits);

/// Tasks run by depth; within one branches first, then the location of what they crossed, then the starts of what
/// leaves there and the loci. Sweeps come before all.
[[nodiscard]] int priority_of(TaskKind kind, int depth);

}  // namespace orbweaver::survey
