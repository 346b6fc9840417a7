#include "alone.hpp"

#include <utility>

#include <fmt/format.h>

#include "flush_round.hpp"
#include "guarded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/stop.hpp"

namespace orbweaver::queue {

Alone::Alone(const Options& options, Executor& executor, Observer& observer, Flusher& flusher)
    : _executor(executor),
      _flusher(flusher),
      _ledger(options, 1, observer),
      _schedule(options, 1),
      _progress_interval(options.progress_seconds),
      _watchdog(options.task_seconds) {}

RunSummary Alone::run(std::vector<Task> initial) {
  try {
    _ledger.add(std::move(initial));
    do_all();
  } catch (...) {
    if (_error.empty()) _error = current_exception_text();
  }
  if (!_error.empty()) throw core::EnvironmentError(run_ended_text(_error));
  _ledger.set_load(0, _load);
  return _ledger.close();
}

void Alone::do_all() {
  while (!stop_requested() && _ledger.counts().waiting > 0) {
    do_next();
    if (!_error.empty()) return;
    _ledger.tick();
    if (_schedule.due()) flush();
  }
  flush();
}

void Alone::do_next() {
  const Task* const task = _ledger.start(0);
  if (task == nullptr) return;
  _key = task->key;
  _unshown_rows = 0;
  _told_to_stop = false;
  _stopped_at.clear();
  _flushed = false;
  _flushed_state = task->state;
  _times.begin();
  _watchdog.began(_key);
  auto [outcome, given_up] = execute_guarded(_executor, *task, *this, [this] { return asked_to_give_up(); });
  if (given_up) {
    _executor.take_back_rows(_flushed);
    _told_to_stop = true;
    _stopped_at = _flushed_state;
  }
  _load.busy_seconds += _times.seconds();
  log_task(*task, outcome, _times.seconds(), _times.silence());
  ++_load.tasks;
  const bool overdue = _watchdog.overdue();
  _watchdog.ended();
  outcome.stopped = _told_to_stop;
  outcome.state = std::move(_stopped_at);
  if (_error.empty()) _ledger.settle(std::move(outcome), overdue);
}

bool Alone::asked_to_give_up() {
  _ledger.tick();  // the time may be over
  return !_told_to_stop && (stop_requested() || _watchdog.overdue());
}

bool Alone::report(const Progress& progress, const StateSource& state) {
  _times.arrived();
  _state = state ? &state : nullptr;
  try {
    if (_error.empty()) note(progress);
  } catch (...) {
    _error = current_exception_text();
  }
  if (stop_requested() || _watchdog.overdue() || !_error.empty()) {
    if (!_told_to_stop && state) _stopped_at = state();
    _told_to_stop = true;
  }
  _state = nullptr;
  _times.left();
  return !_told_to_stop;
}

void Alone::note(const Progress& progress) {
  _unshown_rows += progress.rows;
  _ledger.count_rows(progress.rows);
  _schedule.count(progress.rows);
  if (_progress_interval.over()) {
    _progress_interval.restart();
    Progress shown = progress;
    shown.rows = std::exchange(_unshown_rows, 0);
    _ledger.report(_key, shown, 0);
  }
  _ledger.tick();
  if (_schedule.due()) flush();
}

void Alone::flush() {
  const int number = _flushes++;
  const std::string state = _state != nullptr ? (*_state)() : std::string();
  if (_ledger.counts().running > 0) _ledger.set_state(_key, state);
  _ledger.flushing(number);
  _schedule.begun();
  _watchdog.pause();
  const Stopwatch watch;
  const std::string error = flush_guarded(_flusher, number);
  _times.flushed(watch.seconds());
  _watchdog.resume();
  if (!error.empty()) throw core::EnvironmentError(flush_failed_text(number, {{0, error}}, 1));
  _flushed = true;
  _flushed_state = state;
  _ledger.flushed(number);
  _schedule.flushed();
}

}  // namespace orbweaver::queue
