#pragma once

#include <optional>
#include <vector>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/queue/observer.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

/// Does `tasks`, which count on rank 0 only, for what they give: without rows or flushes by time. Their outcomes by
/// key, on rank 0, with those that failed; empty elsewhere. None, on all ranks, if a stop was asked for before all had
/// ended. Collective over `comm`. Throws as `run` does.
[[nodiscard]] std::optional<std::vector<TaskOutcome>> run_for_outcomes(const core::Communicator& comm,
                                                                       std::vector<Task> tasks, Executor& executor,
                                                                       Observer& observer);
[[nodiscard]] std::optional<std::vector<TaskOutcome>> run_for_outcomes(const core::Communicator& comm,
                                                                       std::vector<Task> tasks, Executor& executor);

}  // namespace orbweaver::queue
