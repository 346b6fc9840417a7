#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>

#include "interval.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/queue/run.hpp"
#include "task_times.hpp"
#include "watchdog.hpp"

namespace orbweaver::queue {

/// The tasks that rank 0 does itself, one at a time. What the run wants of it meanwhile is done at the task's reports
/// and interruption points.
class OwnWork final : private TaskContext {
 public:
  /// Rank 0's part in the run.
  class Duties {
   public:
    virtual void count_rows(std::int64_t rows) = 0;
    virtual void tell(const std::string& key, const Progress& progress) = 0;
    /// `stands`: the task is between two of its steps, and a flush may take place.
    virtual void attend(bool stands) = 0;
    [[nodiscard]] virtual bool stopping() const = 0;

   protected:
    ~Duties() = default;
  };
  struct Done {
    TaskOutcome outcome;
    bool overdue = false;  ///< longer than Options::task_seconds
  };

  OwnWork(const Options& options, Executor& executor, Duties& duties);

  /// Throws what a duty threw.
  [[nodiscard]] Done execute(const Task& task);
  /// Flushes, between two steps or without a task; `told` gets the state of the task under way.
  void flush(const std::function<void(const std::string& key, const std::string& state)>& told,
             const std::function<void()>& flush);
  [[nodiscard]] const RankLoad& load() const { return _load; }

 private:
  bool report(const Progress& progress, const StateSource& state) override;
  void note(const Progress& progress);
  [[nodiscard]] bool asked_to_give_up();
  void tell_to_stop();
  template <class Duty>
  void guard(Duty duty);
  [[nodiscard]] std::string state() const { return _state != nullptr && *_state ? (*_state)() : std::string(); }

  Executor& _executor;
  Duties& _duties;
  Interval _progress_interval;
  Watchdog _watchdog;
  RankLoad _load;
  std::exception_ptr _error;  // what a duty threw

  // Of the task under way.
  std::string _key;  // empty: none
  const StateSource* _state = nullptr;
  std::int64_t _unshown_rows = 0;
  bool _told_to_stop = false;
  std::string _stopped_at;
  bool _flushed = false;
  std::string _flushed_state;
  TaskTimes _times;
};

}  // namespace orbweaver::queue
