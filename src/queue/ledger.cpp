#include "ledger.hpp"

#include <algorithm>
#include <utility>

namespace orbweaver::queue {

Ledger::Ledger(const Options& options, int ranks, Observer& observer)
    : _keep_outcomes(options.keep_outcomes), _observer(observer), _tick(options.tick_seconds) {
  _summary.loads.resize(static_cast<std::size_t>(ranks));
}

void Ledger::add(std::vector<Task> tasks) {
  for (Task& task : tasks) _queue.add(std::move(task));
}

const Task* Ledger::start(int rank) {
  while (_queue.counts().waiting > 0) {
    const Task& task = _queue.start_next();
    if (_observer.wanted(task)) {
      _observer.started(task, rank);
      return &task;
    }
    leave_out(std::string(task.key));
  }
  return nullptr;
}

void Ledger::leave_out(const std::string& key) {
  const Task task = _queue.finish(key);
  _observer.left_out(task);
  if (!_keep_outcomes) return;
  TaskOutcome empty;
  empty.key = key;
  _summary.outcomes.push_back(std::move(empty));
}

void Ledger::report(const std::string& key, const Progress& progress, int rank) {
  _observer.progress(_queue.running(key), progress, rank);
}

void Ledger::settle(TaskOutcome outcome, bool overdue) {
  if (outcome.stopped)
    put_back(outcome, overdue);
  else
    end(outcome);
  if (_keep_outcomes) _summary.outcomes.push_back(std::move(outcome));
}

void Ledger::put_back(const TaskOutcome& outcome, bool overdue) {
  const Task task =
      overdue ? _queue.put_aside(outcome.key, outcome.state) : _queue.put_back(outcome.key, outcome.state);
  if (overdue) _summary.put_aside.push_back(outcome.key);
  ++_summary.stopped;
  _observer.stopped(task, outcome);
}

void Ledger::end(TaskOutcome& outcome) {
  const Task task = outcome.failed ? _queue.fail(outcome.key) : _queue.finish(outcome.key);
  if (outcome.failed) _summary.failures.push_back({outcome.key, outcome.reason});
  if (outcome.failed)
    _observer.failed(task, outcome);
  else
    _observer.finished(task, outcome);
  add(_keep_outcomes ? outcome.children : std::move(outcome.children));
}

void Ledger::tick() {
  if (!_tick.over()) return;
  _tick.restart();
  _observer.tick(_queue.counts());
}

RunSummary Ledger::numbers() const {
  RunSummary summary;
  summary.done = _queue.counts().done;
  summary.failed = _queue.counts().failed;
  summary.waiting = _queue.counts().waiting + _queue.counts().aside;
  summary.stopped = _summary.stopped;
  summary.stopped_early = summary.waiting > 0;
  summary.flushes = _summary.flushes;
  summary.rows = _summary.rows;
  summary.seconds = _since_start.seconds();
  return summary;
}

RunSummary Ledger::close() {
  RunSummary summary = numbers();
  summary.failures = std::move(_summary.failures);
  summary.put_aside = std::move(_summary.put_aside);
  summary.outcomes = std::move(_summary.outcomes);
  summary.loads = std::move(_summary.loads);
  const auto by_key = [](const auto& a, const auto& b) { return a.key < b.key; };
  std::sort(summary.failures.begin(), summary.failures.end(), by_key);
  std::sort(summary.put_aside.begin(), summary.put_aside.end());
  std::sort(summary.outcomes.begin(), summary.outcomes.end(), by_key);
  return summary;
}

}  // namespace orbweaver::queue
