#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "channel.hpp"
#include "interval.hpp"
#include "orbweaver/queue/run.hpp"
#include "task_times.hpp"

namespace orbweaver::queue {

/// Any rank but 0: waits for tasks, does them, takes part in flushes.
class Worker final : public TaskContext {
 public:
  Worker(const core::Communicator& comm, const Options& options, Executor& executor, Flusher& flusher);

  RunSummary run();
  [[nodiscard]] bool report(const Progress& progress, const StateSource& state) override;

 private:
  void work();
  void do_task();
  [[nodiscard]] bool asked_to_give_up();
  void tell(const Progress& progress);
  void pass_on_stop();
  void tell_to_stop();
  [[nodiscard]] std::string state() const;
  Message wait();
  Shutdown wait_for_shutdown();
  void part();
  void take(const Message& message);
  void stand_still(int number);
  void flush(int number);

  const Options& _options;
  Executor& _executor;
  Flusher& _flusher;
  Channel _channel;
  Interval _progress_interval;
  std::optional<Task> _task;
  bool _executing = false;
  std::int64_t _uncounted_rows = 0;  // not yet sent to rank 0
  TaskTimes _times;
  bool _stopping = false;
  bool _passed_on = false;              // that this process was asked to stop the run
  bool _overdue = false;                // rank 0 has ended the running task
  bool _told_to_stop = false;           // the running task
  std::string _stopped_at;              // its state then
  bool _flushed = false;                // since the running task began
  std::string _flushed_state;           // of the running task at the last flush, or when it began
  std::optional<int> _waiting_flush;    // asked for within a step
  const StateSource* _state = nullptr;  // inside report()
  std::string _trouble;                 // met inside report(), which must not throw
  std::optional<Shutdown> _shutdown;
  RankLoad _load;
};

}  // namespace orbweaver::queue
