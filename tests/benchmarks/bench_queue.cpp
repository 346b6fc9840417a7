// The queue alone, under tasks that sleep: what rank 0 can pass on, and how long workers stand idle (docs/scaling.md).
//   mpirun -n 8 bench_queue --milliseconds 0 1 10 100 --kilobytes 0 10 100 1000     a line for each pair
//   mpirun -n 8 bench_queue --replay table.csv --copies 10                          ten times the tasks of a survey
// us0 is processor time of rank 0: its own cost, whatever else runs on its core.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>
#include <CLI/CLI.hpp>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/run.hpp"
#include "task_table.hpp"

namespace {

using namespace orbweaver;

struct Settings {
  std::vector<double> milliseconds{0, 1, 10, 100};
  std::vector<double> kilobytes{0, 10, 100, 1000};
  double duration = 2.0;  // seconds a measurement, about
  double flush = 0.0;     // seconds between flushes, 0: none but the last
  double state = 0.0;     // kB that each busy worker hands over at a flush
  std::string table;
  int copies = 1;
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Tasks of a table, each of them as often as there are copies. A key is "copy/row".
class Sleeper final : public queue::Executor {
 public:
  Sleeper(const std::vector<TaskRow>& rows, double state_kilobytes)
      : _rows(rows), _state(static_cast<std::size_t>(1e3 * state_kilobytes), 's') {}

  [[nodiscard]] queue::Task task(int copy, int row) const {
    const TaskRow& r = _rows[static_cast<std::size_t>(row)];
    return {fmt::format("{:06}/{:05}", copy, row), r.priority, "sleep", std::string(r.bytes_in, 'x')};
  }

  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override {
    int copy = 0;
    int number = 0;
    const char* const end = task.key.data() + task.key.size();
    std::from_chars(std::from_chars(task.key.data(), end, copy).ptr + 1, end, number);
    const TaskRow& row = _rows[static_cast<std::size_t>(number)];
    std::int64_t steps = 0;
    for (double left = row.seconds; left > 0; left -= row.silence) {
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, row.silence)));
      if (!context.report({++steps, 1, {}}, [this] { return _state; })) break;
    }
    queue::TaskOutcome outcome;
    outcome.payload.assign(row.bytes_out, 'x');
    for (const int child : row.children) outcome.children.push_back(this->task(copy, child));
    return outcome;
  }

 private:
  const std::vector<TaskRow>& _rows;
  std::string _state;
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

void print_head() {
  fmt::print("{:>7} {:>8} {:>8} {:>8} {:>9} {:>9} {:>10} {:>9} {:>9} {:>7} {:>7}\n", "workers", "task/ms", "load/kB",
             "tasks", "wall/s", "tasks/s", "messages/s", "us0/task", "us0/msg", "cpu0/%", "idle/%");
}

void measure(const core::Communicator& comm, const Settings& settings, const std::vector<TaskRow>& rows, int copies) {
  const int workers = comm.size() - 1;
  Sleeper executor(rows, settings.state);
  std::vector<queue::Task> tasks;
  for (int copy = 0; copy < copies && comm.is_root(); ++copy)
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (rows[row].parent < 0) tasks.push_back(executor.task(copy, static_cast<int>(row)));
  Nothing flusher;
  Counter counter;
  queue::Options options;
  options.flush_seconds = settings.flush;
  options.flush_rows = 0;
  options.root_works_up_to = 1;  // workers are what is simulated
  MPI_Barrier(comm.get());
  const double cpu_before = cpu_seconds();
  const queue::RunSummary summary = queue::run(comm, options, std::move(tasks), executor, counter, flusher);
  const double cpu = cpu_seconds() - cpu_before;
  if (!comm.is_root()) return;
  double busy = 0.0;
  for (const queue::RankLoad& load : summary.loads) busy += load.busy_seconds;
  const auto done = static_cast<double>(summary.done);
  const auto count = static_cast<double>(rows.size());
  double bytes = 0.0;
  for (const TaskRow& row : rows) bytes += static_cast<double>(row.bytes_in + row.bytes_out) / 2;
  // An assign and an outcome a task, four messages a worker and flush, and hello, shutdown, goodbye.
  const double messages =
      2 * done + static_cast<double>(counter.progress_messages) + (4.0 * summary.flushes + 3) * workers;
  fmt::print("{:>7} {:>8.4g} {:>8.4g} {:>8} {:>9.2f} {:>9.1f} {:>10.1f} {:>9.1f} {:>9.1f} {:>7.1f} {:>7.1f}\n", workers,
             1e3 * total_seconds(rows) / count, 1e-3 * bytes / count, summary.done, summary.seconds,
             done / summary.seconds, messages / summary.seconds, 1e6 * cpu / done, 1e6 * cpu / messages,
             100 * cpu / summary.seconds, 100 * (1 - busy / (workers * summary.seconds)));
  std::fflush(stdout);
}

// Tasks of one length; enough for about the wanted duration, if a worker waits 0.2 ms between two and rank 0 needs 20
// us and 1 ns a byte.
void measure_equal(const core::Communicator& comm, const Settings& settings, double seconds, double bytes) {
  const int workers = comm.size() - 1;
  const double rate = std::min(workers / (seconds + 2e-4), 1.0 / (2e-5 + 1e-9 * bytes));
  const std::vector<TaskRow> rows{{.seconds = seconds,
                                   .silence = std::max(seconds / 100, std::min(seconds, 0.01)),
                                   .bytes_in = static_cast<std::size_t>(bytes),
                                   .bytes_out = static_cast<std::size_t>(bytes)}};
  measure(comm, settings, rows, std::max(4 * workers, static_cast<int>(settings.duration * rate)));
}

void measure_all(const core::Communicator& comm, const Settings& settings) {
  if (comm.size() == 1) {
    std::fputs("bench_queue measures messages: start it with mpirun -n 2 or more\n", stderr);
    return;
  }
  if (settings.table.empty()) {
    if (comm.is_root()) print_head();
    for (const double ms : settings.milliseconds)
      for (const double kb : settings.kilobytes) measure_equal(comm, settings, 1e-3 * ms, 1e3 * kb);
    return;
  }
  const std::vector<TaskRow> rows = read_task_table(settings.table);
  if (comm.is_root()) {
    fmt::print("{} tasks x {}: {:.1f} s of work, {:.1f} s in the longest chain\n", rows.size(), settings.copies,
               settings.copies * total_seconds(rows), chain_seconds(rows));
    print_head();
  }
  measure(comm, settings, rows, settings.copies);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("The queue alone, under tasks that sleep");
  app.add_option("--milliseconds", settings.milliseconds, "Lengths of tasks");
  app.add_option("--kilobytes", settings.kilobytes, "Sizes of payloads, there and back");
  app.add_option("--duration", settings.duration, "Seconds a measurement, about");
  app.add_option("--flush", settings.flush, "Seconds between flushes; 0: none but the last");
  app.add_option("--state", settings.state, "Kilobytes of state that a busy worker hands over at a flush");
  app.add_option("--replay", settings.table, "Tasks of a survey (task_table.py) instead");
  app.add_option("--copies", settings.copies, "As if there were so many such surveys");
  CLI11_PARSE(app, argc, argv);
  MPI_Init(&argc, &argv);
  measure_all(core::Communicator(), settings);
  MPI_Finalize();
  return 0;
}
