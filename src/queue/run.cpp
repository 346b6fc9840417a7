#include "orbweaver/queue/run.hpp"

#include <utility>

#include "coordinator.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"
#include "worker.hpp"

namespace orbweaver::queue {

namespace {

void require_valid(const Options& options) {
  core::require(options.flush_seconds >= 0, "flush_seconds must be 0 or more");
  core::require(options.flush_rows >= 0, "flush_rows must be 0 or more");
  core::require(options.flush_share > 0, "flush_share must be more than 0");
  core::require(options.progress_seconds >= 0, "progress_seconds must be 0 or more");
  core::require(options.root_works_up_to >= 0, "root_works_up_to must be 0 or more");
  core::require(options.task_seconds >= 0, "task_seconds must be 0 or more");
  core::require(options.stop_seconds >= 0, "stop_seconds must be 0 or more");
  core::require(options.tick_seconds >= 0, "tick_seconds must be 0 or more");
  core::require(options.shortest_sleep.count() > 0, "shortest_sleep must be more than 0, or a waiting rank would spin");
  core::require(options.longest_sleep >= options.shortest_sleep, "longest_sleep must not be less than shortest_sleep");
}

}  // namespace

RunSummary run(const core::Communicator& comm, const Options& options, std::vector<Task> initial, Executor& executor,
               Observer& observer, Flusher& flusher) {
  require_valid(options);
  RunSummary summary = comm.is_root() ? Coordinator(comm, options, executor, observer, flusher).run(std::move(initial))
                                      : Worker(comm, options, executor, flusher).run();
  // A worker must not say hello to a next run before rank 0 has heard every goodbye of this one: it would be dropped.
  core::check_mpi(MPI_Barrier(comm.get()), "MPI_Barrier");
  return summary;
}

}  // namespace orbweaver::queue
