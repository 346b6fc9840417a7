#pragma once

#include <functional>
#include <string>

#include "orbweaver/queue/progress.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

/// Gives the state of running work: bytes from which `execute` can go on, rows reported so far not repeated. Empty
/// bytes: it has to begin again (work without rows only).
using StateSource = std::function<std::string()>;

/// What running work sees of the run.
class TaskContext {
 public:
  virtual ~TaskContext() = default;

  /// To be called between the steps of the work, every millisecond to every second, with all rows of the finished
  /// steps where the Flusher finds them: a flush takes place inside this call. Tells rank 0 (seldom enough not to
  /// flood it) and costs microseconds otherwise. Never throws.
  /// Returns false when the run is to stop: the work then returns its outcome so far at once.
  /// `state` is asked within the call, if a flush or a stop comes, for the state after the finished steps.
  [[nodiscard]] virtual bool report(const Progress& progress, const StateSource& state = {}) = 0;
};

/// Does the work of a rank.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Called on any rank that computes, one task at a time; goes on from `task.state` if there is one. Whatever it
  /// throws becomes a failed outcome with the exception's text as its reason, and the run goes on.
  virtual TaskOutcome execute(const Task& task, TaskContext& context) = 0;

  /// Called after `execute` was given up within a step (core::interruption_point), which a stop may do: rows that it
  /// has put where the Flusher finds them are to be taken back, those since the last flush (`flushed`), or since it
  /// began. The task goes on from its state at that time.
  virtual void take_back_rows(bool /*flushed*/) {}
};

}  // namespace orbweaver::queue
