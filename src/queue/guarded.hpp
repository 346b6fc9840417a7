#pragma once

#include <exception>
#include <functional>
#include <string>

#include "deadlines.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/queue/flusher.hpp"

namespace orbweaver::queue {

/// The text of the exception being handled, printable (core::printable_lines); call inside a catch block. Never empty.
[[nodiscard]] std::string current_exception_text();

struct Execution {
  TaskOutcome outcome;    ///< with its key filled in
  bool given_up = false;  ///< within a step; the outcome is empty
};

/// What the executor comes to; an exception becomes a failed outcome. `asked`: whether to give it up within a step.
[[nodiscard]] Execution execute_guarded(Executor& executor, const Task& task, TaskContext& context,
                                        const std::function<bool()>& asked);

/// What a program says before it ends because work ("task X on rank 2") neither ends nor reports.
[[nodiscard]] std::string unresponsive_text(const std::string& work, const Deadlines::Unresponsive& found);
/// "task X on rank 2"
[[nodiscard]] std::string task_text(const std::string& key, int rank);

/// A debug line on a task that has ended here: how long it took, the longest time it let pass without a report (s),
/// bytes in and out, and its children.
void log_task(const Task& task, const TaskOutcome& outcome, double seconds, double silence);

/// Flushes; returns the text of what was thrown, empty if nothing was.
[[nodiscard]] std::string flush_guarded(Flusher& flusher, int number);

}  // namespace orbweaver::queue
