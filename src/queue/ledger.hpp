#pragma once

#include <string>
#include <utility>
#include <vector>

#include "interval.hpp"
#include "orbweaver/queue/observer.hpp"
#include "orbweaver/queue/run.hpp"
#include "orbweaver/queue/task_queue.hpp"

namespace orbweaver::queue {

/// What rank 0 knows of a run: the queue, what became of its tasks, and the observer who is told.
class Ledger {
 public:
  Ledger(const Options& options, int ranks, Observer& observer);

  void add(std::vector<Task> tasks);
  /// Starts the first waiting task that is wanted for `rank`, and leaves out those before it. Null: none waits now.
  const Task* start(int rank);
  void report(const std::string& key, const Progress& progress, int rank);
  /// What became of a task. `overdue`: its time was over; if it was stopped, it does not wait for another turn.
  void settle(TaskOutcome outcome, bool overdue);
  void count_rows(std::int64_t rows) { _summary.rows += rows; }
  void tick();

  void flushing(int number) { _observer.flushing(number, _queue); }
  void set_state(const std::string& key, std::string state) { _queue.set_state(key, std::move(state)); }
  void flushed(int number) {
    ++_summary.flushes;
    _observer.flushed(number);
  }
  void set_load(int rank, const RankLoad& load) { _summary.loads[static_cast<std::size_t>(rank)] = load; }

  [[nodiscard]] const TaskCounts& counts() const noexcept { return _queue.counts(); }
  /// The counts so far, without the lists.
  [[nodiscard]] RunSummary numbers() const;
  /// All of it; ends the ledger.
  [[nodiscard]] RunSummary close();

 private:
  void put_back(const TaskOutcome& outcome, bool overdue);
  void end(TaskOutcome& outcome);
  void leave_out(const std::string& key);

  bool _keep_outcomes;
  Observer& _observer;
  TaskQueue _queue;
  RunSummary _summary;
  Interval _tick;
  Stopwatch _since_start;
};

}  // namespace orbweaver::queue
