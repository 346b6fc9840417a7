#pragma once

#include <string>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::queue {

/// A piece of work. The queue never looks into `kind` and `payload`; they belong to whoever makes and executes tasks.
struct Task {
  std::string key;      ///< unique in a run and not empty; the same work has the same key in every run
  int priority = 0;     ///< smaller runs first; ties go by key, compared byte by byte
  std::string kind;     ///< what the executor is to do
  std::string payload;  ///< serialised input, any bytes
  std::string state{};  ///< how far an earlier attempt has come, in the executor's bytes; empty: from the beginning

  friend bool operator==(const Task&, const Task&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, priority, kind, payload, state);
  }
};

/// What became of a task. Must be a pure function of the task's key, kind and payload, so that a run depends neither on
/// the number of ranks nor on where earlier attempts were cut off: going on from a state comes to the same end.
struct TaskOutcome {
  std::string key;  ///< filled in by the queue
  bool failed = false;
  std::string reason;  ///< why it failed; never empty in a failed outcome
  std::vector<Task>
      children;          ///< queued when the outcome arrives, also those of a failed task; not those of a stopped one
  std::string payload;   ///< serialised result, any bytes
  bool stopped = false;  ///< filled in by the queue: report() had told the work to stop, so this is not its end
  std::string state{};   ///< filled in by the queue if stopped: where to go on

  friend bool operator==(const TaskOutcome&, const TaskOutcome&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, failed, reason, children, payload, stopped, state);
  }
};

}  // namespace orbweaver::queue
