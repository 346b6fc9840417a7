#include "orbweaver/queue/task_queue.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::queue {

void TaskQueue::add(Task task) {
  core::require(!task.key.empty(), "a task needs a key, and got an empty one");
  if (!_states.emplace(task.key, TaskState::waiting).second)
    throw core::MisuseError(
        fmt::format("the key of a task must be new to the queue; \"{}\" was added before", task.key));
  Place place{task.priority, task.key};
  _waiting.emplace(std::move(place), std::move(task));
  ++_counts.waiting;
}

const Task& TaskQueue::start_next() {
  core::require(!_waiting.empty(), "start_next needs a waiting task, and none waits");
  auto node = _waiting.extract(_waiting.begin());
  Task& task = node.mapped();
  _states[task.key] = TaskState::running;
  --_counts.waiting;
  ++_counts.running;
  std::string key = task.key;
  return _running.emplace(std::move(key), std::move(task)).first->second;
}

Task TaskQueue::leave_running(const std::string& key) {
  auto node = _running.extract(key);
  if (node.empty()) throw core::MisuseError(fmt::format("task \"{}\" was expected to be running, and is not", key));
  --_counts.running;
  return std::move(node.mapped());
}

Task TaskQueue::finish(const std::string& key) {
  Task task = leave_running(key);
  _states[task.key] = TaskState::done;
  ++_counts.done;
  return task;
}

Task TaskQueue::fail(const std::string& key) {
  Task task = leave_running(key);
  _states[task.key] = TaskState::failed;
  ++_counts.failed;
  return task;
}

Task TaskQueue::put_back(const std::string& key, std::string state) {
  Task task = leave_running(key);
  task.state = std::move(state);
  _states[task.key] = TaskState::waiting;
  _waiting.emplace(Place{task.priority, task.key}, task);
  ++_counts.waiting;
  return task;
}

Task TaskQueue::put_aside(const std::string& key, std::string state) {
  Task task = leave_running(key);
  task.state = std::move(state);
  _states[task.key] = TaskState::aside;
  _aside.push_back(task);
  ++_counts.aside;
  return task;
}

void TaskQueue::set_state(const std::string& key, std::string state) {
  const auto found = _running.find(key);
  if (found == _running.end())
    throw core::MisuseError(fmt::format("task \"{}\" was expected to be running, and is not", key));
  found->second.state = std::move(state);
}

TaskState TaskQueue::state(const std::string& key) const {
  const auto found = _states.find(key);
  if (found == _states.end()) throw core::MisuseError(fmt::format("the queue has no task \"{}\"", key));
  return found->second;
}

const Task& TaskQueue::running(const std::string& key) const {
  const auto found = _running.find(key);
  if (found == _running.end())
    throw core::MisuseError(fmt::format("task \"{}\" was expected to be running, and is not", key));
  return found->second;
}

std::vector<Task> TaskQueue::unfinished() const {
  std::vector<Task> tasks = _aside;
  tasks.reserve(_aside.size() + _waiting.size() + _running.size());
  for (const auto& [place, task] : _waiting) tasks.push_back(task);
  for (const auto& [key, task] : _running) tasks.push_back(task);
  std::sort(tasks.begin(), tasks.end(),
            [](const Task& a, const Task& b) { return std::tie(a.priority, a.key) < std::tie(b.priority, b.key); });
  return tasks;
}

}  // namespace orbweaver::queue
