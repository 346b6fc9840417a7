// A run with a task that neither ends nor reports, and a flush that waits for it: the program must end all the same, by
// the time of a task, with `stop` as its argument by a stop, and with `before` by one outside of a run.
#include <chrono>
#include <string>
#include <thread>

#include <mpi.h>

#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/run.hpp"
#include "orbweaver/queue/stop.hpp"

namespace {

using namespace orbweaver;

void sleep_for_ever() { std::this_thread::sleep_for(std::chrono::hours(1)); }

class Unresponsive final : public queue::Executor {
 public:
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext&) override {
    if (task.key == "unresponsive") sleep_for_ever();
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
    options.flush_seconds = 0.1;
    std::thread stopper;
    const std::string ends_by = argc > 1 ? argv[1] : "";
    if (ends_by.empty()) {
      options.task_seconds = 0.5;
    } else {
      options.stop_seconds = 0.5;
      if (comm.is_root())
        stopper = std::thread([] {
          std::this_thread::sleep_for(std::chrono::milliseconds(500));
          queue::request_stop();
        });
      if (ends_by == "before" && comm.is_root())
        queue::do_interruptibly(
            "the beginning", [] { return false; }, sleep_for_ever, options.stop_seconds);
    }
    Unresponsive executor;
    Nothing flusher;
    queue::Observer nobody;
    queue::run(comm, options, {{"a", 0, "", ""}, {"unresponsive", 1, "", ""}, {"z", 2, "", ""}}, executor, nobody,
               flusher);
  }
  MPI_Finalize();
  return 0;
}
