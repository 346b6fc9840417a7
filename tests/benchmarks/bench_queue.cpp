// The queue alone, under synthetic tasks that sleep: what rank 0 can pass on, and how long workers stand idle.
//   mpirun -n 8 bench_queue --milliseconds 0 1 10 100 --kilobytes 0 10 100 1000
// A line for each pair: rates, rank 0's processor time (its own cost, whatever else runs on its core), idle time of workers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>
#include <CLI/CLI.hpp>

#include "orbweaver/core/communicator.hpp"
#include "orbweaver/queue/run.hpp"

namespace {

using namespace orbweaver;

struct Load {
  double seconds = 0.0;   // of a task
  std::size_t bytes = 0;  // of its payload, and of its outcome's
  double step = 0.01;     // seconds between reports
  double duration = 2.0;  // of the measurement, about
  double flush = 0.0;     // seconds between flushes, 0: none
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Sleeper final : public queue::Executor {
 public:
  explicit Sleeper(const Load& load) : _load(load) {}
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override {
    std::int64_t steps = 0;
    for (double left = _load.seconds; left > 0; left -= _load.step) {
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, _load.step)));
      if (!context.report({++steps, 1, {}})) break;
    }
    queue::TaskOutcome outcome;
    outcome.payload = task.payload;
    return outcome;
  }

 private:
  const Load& _load;
};

class Nothing final : public queue::Flusher {
 public:
  void flush(int) override {}
};

class Counter final : public queue::Observer {
 public:
  void progress(const queue::Task&, const queue::Progress&, int) override { ++progress_messages; }
  std::int64_t progress_messages = 0;
};

// Enough tasks for about the wanted duration, if a worker waits 0.2 ms between two and rank 0 needs 20 us and 1 ns a byte.
std::size_t task_count(const Load& load, int workers) {
  const double by_workers = workers / (load.seconds + 2e-4);
  const double by_rank0 = 1.0 / (2e-5 + 1e-9 * static_cast<double>(load.bytes));
  return std::max<std::size_t>(4 * static_cast<std::size_t>(workers),
                               static_cast<std::size_t>(load.duration * std::min(by_workers, by_rank0)));
}

void measure(const core::Communicator& comm, const Load& load) {
  const int workers = comm.size() - 1;
  std::vector<queue::Task> tasks;
  if (comm.is_root())
    for (std::size_t i = 0; i < task_count(load, workers); ++i)
      tasks.push_back({fmt::format("{:06}", i), 0, "sleep", std::string(load.bytes, 'x')});
  Sleeper executor(load);
  Nothing flusher;
  Counter counter;
  queue::Options options;
  options.flush_seconds = load.flush;
  options.flush_rows = 0;
  MPI_Barrier(comm.get());
  const double cpu_before = cpu_seconds();
  const queue::RunSummary summary = queue::run(comm, options, std::move(tasks), executor, counter, flusher);
  const double cpu = cpu_seconds() - cpu_before;
  if (!comm.is_root()) return;
  double busy = 0.0;
  for (const queue::RankLoad& rank : summary.loads) busy += rank.busy_seconds;
  const auto done = static_cast<double>(summary.done);
  // An assign and an outcome a task, four messages a worker and flush, and hello, shutdown, goodbye.
  const double messages =
      2 * done + static_cast<double>(counter.progress_messages) + (4.0 * summary.flushes + 3) * workers;
  fmt::print("{:>5} {:>8g} {:>8g} {:>8} {:>8.2f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>7.1f} {:>7.1f}\n", comm.size(),
             1e3 * load.seconds, static_cast<double>(load.bytes) / 1e3, summary.done, summary.seconds,
             done / summary.seconds, messages / summary.seconds, 1e6 * cpu / done, 1e6 * cpu / messages,
             100 * cpu / summary.seconds, 100 * (1 - busy / (workers * summary.seconds)));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> milliseconds{0, 1, 10, 100};
  std::vector<double> kilobytes{0, 10, 100, 1000};
  Load load;
  CLI::App app("The queue alone, under synthetic tasks that sleep");
  app.add_option("--milliseconds", milliseconds, "Lengths of tasks");
  app.add_option("--kilobytes", kilobytes, "Sizes of payloads, there and back");
  app.add_option("--duration", load.duration, "Seconds a measurement, about");
  app.add_option("--flush", load.flush, "Seconds between flushes; 0: none but the last");
  CLI11_PARSE(app, argc, argv);
  MPI_Init(&argc, &argv);
  {
    const core::Communicator comm;
    if (comm.size() == 1) {
      std::fputs("bench_queue measures messages: start it with mpirun -n 2 or more\n", stderr);
    } else {
      if (comm.is_root())
        fmt::print("{:>5} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}\n", "ranks", "task/ms", "load/kB",
                   "tasks", "wall/s", "tasks/s", "messages/s", "us0/task", "us0/msg", "cpu0/%", "idle/%");
      for (const double ms : milliseconds)
        for (const double kb : kilobytes) {
          load.seconds = 1e-3 * ms;
          load.bytes = static_cast<std::size_t>(1e3 * kb);
          measure(comm, load);
        }
    }
  }
  MPI_Finalize();
  return 0;
}
