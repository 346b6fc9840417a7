#pragma once

#include <string>
#include <vector>

#include "flush_schedule.hpp"
#include "ledger.hpp"
#include "orbweaver/queue/run.hpp"
#include "task_times.hpp"
#include "watchdog.hpp"

namespace orbweaver::queue {

/// A run on one rank, which keeps the queue and does the tasks, without messages.
class Alone final : public TaskContext {
 public:
  Alone(const Options& options, Executor& executor, Observer& observer, Flusher& flusher);

  RunSummary run(std::vector<Task> initial);
  [[nodiscard]] bool report(const Progress& progress, const StateSource& state) override;

 private:
  void do_all();
  void do_next();
  [[nodiscard]] bool asked_to_give_up();
  void note(const Progress& progress);
  void flush();

  Executor& _executor;
  Flusher& _flusher;
  Ledger _ledger;
  FlushSchedule _schedule;
  Interval _progress_interval;
  std::string _key;                // of the running task
  std::int64_t _unshown_rows = 0;  // not yet told to the observer
  TaskTimes _times;
  Watchdog _watchdog;
  bool _told_to_stop = false;           // the running task
  std::string _stopped_at;              // its state then
  bool _flushed = false;                // since the running task began
  std::string _flushed_state;           // of the running task at the last flush, or when it began
  const StateSource* _state = nullptr;  // inside report()
  std::string _error;                   // met inside report(), which must not throw
  int _flushes = 0;
  RankLoad _load;
};

}  // namespace orbweaver::queue
