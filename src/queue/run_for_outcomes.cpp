#include "orbweaver/queue/run_for_outcomes.hpp"

#include <utility>

#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/queue/run.hpp"

namespace orbweaver::queue {

namespace {

class NothingToFlush final : public Flusher {
  void flush(int /*number*/) override {}
};

}  // namespace

std::optional<std::vector<TaskOutcome>> run_for_outcomes(const core::Communicator& comm, std::vector<Task> tasks,
                                                         Executor& executor, Observer& observer) {
  if (!core::agreed(comm.get(), !tasks.empty())) return std::vector<TaskOutcome>{};
  NothingToFlush flusher;
  Options options;
  options.keep_outcomes = true;
  options.flush_seconds = 0.0;
  options.flush_rows = 0;
  RunSummary summary = run(comm, options, std::move(tasks), executor, observer, flusher);
  if (summary.stopped_early) return std::nullopt;
  return std::move(summary.outcomes);
}

std::optional<std::vector<TaskOutcome>> run_for_outcomes(const core::Communicator& comm, std::vector<Task> tasks,
                                                         Executor& executor) {
  Observer nobody;
  return run_for_outcomes(comm, std::move(tasks), executor, nobody);
}

}  // namespace orbweaver::queue
