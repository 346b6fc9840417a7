#include "guarded.hpp"

#include <fmt/format.h>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::queue {

std::string current_exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    const std::string text = core::printable_lines(error.what());  // of any bytes
    return text.empty() ? "an exception without a message" : text;
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

Execution execute_guarded(Executor& executor, const Task& task, TaskContext& context,
                          const std::function<bool()>& asked) {
  Execution execution;
  TaskOutcome& outcome = execution.outcome;
  try {
    const core::InterruptionScope scope(asked);
    outcome = executor.execute(task, context);
  } catch (const core::Interrupted&) {
    outcome = {};
    execution.given_up = true;
  } catch (...) {
    outcome.failed = true;
    outcome.reason = current_exception_text();
  }
  outcome.key = task.key;
  outcome.reason = core::recordable(outcome.reason);
  if (outcome.failed && outcome.reason.empty()) outcome.reason = "the executor gave no reason";
  return execution;
}

std::string unresponsive_text(const std::string& work, const Deadlines::Unresponsive& found) {
  const std::string late =
      found.stopping
          ? fmt::format("{} was asked to stop and has not come to an end of a step for {:g} s", work, found.seconds)
          : fmt::format("{} was to end after {:g} s and has not done so in the same time again", work, found.seconds);
  return fmt::format(
      "{}; ending the program: what the last flush wrote is safe, and a run that "
      "goes on from it begins with that work again",
      late);
}

std::string task_text(const std::string& key, int rank) { return fmt::format("task {} on rank {}", key, rank); }

void log_task(const Task& task, const TaskOutcome& outcome, double seconds, double silence) {
  if (!core::logs_debug()) return;
  std::string children;
  for (const Task& child : outcome.children) children += (children.empty() ? " " : ", ") + child.key;
  core::log_debug(fmt::format(
      "queue: task {} ({}, priority {}) took {:.6f} s, silent {:.6f} s, {} bytes in, {} out, children:{}", task.key,
      task.kind, task.priority, seconds, silence, task.payload.size(), outcome.payload.size(), children));
}

std::string flush_guarded(Flusher& flusher, int number) {
  try {
    flusher.flush(number);
    return {};
  } catch (...) {
    return current_exception_text();
  }
}

}  // namespace orbweaver::queue
