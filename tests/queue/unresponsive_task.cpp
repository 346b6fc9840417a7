// A run with a task that neither ends nor reports, and a flush that waits for it: the program must end all the same.
#include <chrono>
#include <thread>

#include <mpi.h>

#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/run.hpp"

namespace {

using namespace orbweaver;

class Unresponsive final : public queue::Executor {
 public:
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext&) override {
    if (task.key == "unresponsive") std::this_thread::sleep_for(std::chrono::hours(1));
    return {};
  }
};

class Nothing final : public queue::Flusher {
 public:
  void flush(int) override {}
};

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    const core::Communicator comm;
    core::start_logging(core::LogLevel::info, comm.rank(), comm.size());
    queue::Options options;
    options.task_seconds = 0.5;
    options.flush_seconds = 0.1;
    Unresponsive executor;
    Nothing flusher;
    queue::Observer nobody;
    queue::run(comm, options, {{"a", 0, "", ""}, {"unresponsive", 1, "", ""}, {"z", 2, "", ""}}, executor, nobody,
               flusher);
  }
  MPI_Finalize();
  return 0;
}
