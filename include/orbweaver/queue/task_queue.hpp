#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

enum class TaskState { waiting, aside, running, done, failed };

struct TaskCounts {
  std::size_t waiting = 0;
  std::size_t running = 0;
  std::size_t done = 0;
  std::size_t failed = 0;
  std::size_t aside = 0;  ///< interrupted, and not to be handed out again in this run

  friend bool operator==(const TaskCounts&, const TaskCounts&) = default;
};

/// The tasks of a run and their states. The order is a pure function of (priority, key), whatever order they came in.
/// Of a finished task only the key stays, so memory follows what is waiting and running.
/// Every function throws MisuseError when a task is not in the state that it asks for.
class TaskQueue {
 public:
  /// Adds a waiting task. Throws MisuseError for an empty key or one that the queue has ever had.
  void add(Task task);
  /// Moves the first waiting task to running. The reference holds until the task leaves that state.
  const Task& start_next();
  /// Running -> done, failed, or back to waiting (interrupted). Each returns the task.
  Task finish(const std::string& key);
  Task fail(const std::string& key);
  Task put_back(const std::string& key, std::string state);
  /// Running -> aside.
  Task put_aside(const std::string& key, std::string state);
  /// Where a running task would go on from.
  void set_state(const std::string& key, std::string state);

  [[nodiscard]] TaskState state(const std::string& key) const;
  [[nodiscard]] const Task& running(const std::string& key) const;
  [[nodiscard]] const TaskCounts& counts() const noexcept { return _counts; }
  /// Waiting, running and put-aside tasks in the queue's order: what a restart would begin with.
  [[nodiscard]] std::vector<Task> unfinished() const;

 private:
  using Place = std::pair<int, std::string>;
  Task leave_running(const std::string& key);

  std::map<Place, Task> _waiting;
  std::vector<Task> _aside;
  std::unordered_map<std::string, Task> _running;
  std::unordered_map<std::string, TaskState> _states;
  TaskCounts _counts;
};

}  // namespace orbweaver::queue
