#pragma once

#include "orbweaver/queue/progress.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/queue/task_queue.hpp"

namespace orbweaver::queue {

/// Told on rank 0 what happens, in the order of arrival. Calls must be short: workers wait meanwhile. What a call
/// throws ends the run on all ranks with EnvironmentError. By default every call does nothing.
class Observer {
 public:
  virtual ~Observer() = default;

  /// Asked when `task` is about to be handed out, or to be done here: whether it shall be. When it shall not, the task
  /// is done, with an empty outcome and without children, and left_out is called instead of started and finished. The
  /// answer may rest on what has ended so far, which differs between runs (docs/protocol.md).
  [[nodiscard]] virtual bool wanted(const Task& /*task*/) { return true; }
  virtual void left_out(const Task& /*task*/) {}
  /// `rank` begins with `task`.
  virtual void started(const Task& /*task*/, int /*rank*/) {}
  /// `progress.rows` counts the rows since the last call for this task; reports in between may have been merged.
  virtual void progress(const Task& /*task*/, const Progress& /*progress*/, int /*rank*/) {}
  virtual void finished(const Task& /*task*/, const TaskOutcome& /*outcome*/) {}
  virtual void failed(const Task& /*task*/, const TaskOutcome& /*outcome*/) {}
  /// The task was interrupted by an early stop and waits again.
  virtual void stopped(const Task& /*task*/, const TaskOutcome& /*outcome*/) {}
  /// All ranks stand still and are about to flush. Every outcome sent before has arrived and nothing else is on its
  /// way, so that `queue`, where running tasks have the states that their workers gave, is the whole state of the run.
  virtual void flushing(int /*number*/, const TaskQueue& /*queue*/) {}
  /// That flush has succeeded on all ranks. Outcomes may have come since `flushing`.
  virtual void flushed(int /*number*/) {}
  /// About ten times a second.
  virtual void tick(const TaskCounts& /*counts*/) {}
};

}  // namespace orbweaver::queue
