#pragma once

#include <exception>
#include <string>

#include "orbweaver/queue/executor.hpp"
#include "orbweaver/queue/flusher.hpp"

namespace orbweaver::queue {

/// The text of the exception being handled; call inside a catch block. Never empty.
[[nodiscard]] std::string current_exception_text();

/// The executor's outcome with its key filled in; a thrown exception becomes a failed outcome.
[[nodiscard]] TaskOutcome execute_guarded(Executor& executor, const Task& task, TaskContext& context);

/// What a program says before it ends because a task neither ends nor reports.
[[nodiscard]] std::string unresponsive_text(const std::string& key, int rank, double task_seconds);

/// A debug line on a task that has ended here: how long it took, the longest time it let pass without a report (s),
/// bytes in and out, and its children.
void log_task(const Task& task, const TaskOutcome& outcome, double seconds, double silence);

/// Flushes; returns the text of what was thrown, empty if nothing was.
[[nodiscard]] std::string flush_guarded(Flusher& flusher, int number);

}  // namespace orbweaver::queue
