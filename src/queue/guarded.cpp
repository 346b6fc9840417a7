#include "guarded.hpp"

namespace orbweaver::queue {

std::string current_exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    const std::string text = error.what();
    return text.empty() ? "an exception without a message" : text;
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

TaskOutcome execute_guarded(Executor& executor, const Task& task, TaskContext& context) {
  TaskOutcome outcome;
  try {
    outcome = executor.execute(task, context);
  } catch (...) {
    outcome.failed = true;
    outcome.reason = current_exception_text();
  }
  outcome.key = task.key;
  if (outcome.failed && outcome.reason.empty()) outcome.reason = "the executor gave no reason";
  return outcome;
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
