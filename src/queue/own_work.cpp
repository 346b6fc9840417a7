#include "own_work.hpp"

#include <utility>

#include "guarded.hpp"

namespace orbweaver::queue {

OwnWork::OwnWork(const Options& options, Executor& executor, Duties& duties)
    : _executor(executor),
      _duties(duties),
      _progress_interval(options.progress_seconds),
      _watchdog(options.task_seconds, options.stop_seconds) {}

OwnWork::Done OwnWork::execute(const Task& task) {
  _key = task.key;
  _unshown_rows = 0;
  _told_to_stop = false;
  _stopped_at.clear();
  _flushed = false;
  _flushed_state = task.state;
  _times.begin();
  _watchdog.began(task_text(_key, 0));
  auto [outcome, given_up] = execute_guarded(_executor, task, *this, [this] { return asked_to_give_up(); });
  if (given_up) {
    _executor.take_back_rows(_flushed);
    _told_to_stop = true;
    _stopped_at = _flushed_state;
  }
  _load.busy_seconds += _times.seconds();
  log_task(task, outcome, _times.seconds(), _times.silence());
  ++_load.tasks;
  const bool overdue = _watchdog.overdue();
  _watchdog.ended();
  _key.clear();
  if (_error) std::rethrow_exception(_error);
  outcome.stopped = _told_to_stop;
  outcome.state = std::move(_stopped_at);
  return {std::move(outcome), overdue};
}

template <class Duty>
void OwnWork::guard(Duty duty) {
  if (_error) return;
  try {
    duty();
  } catch (...) {
    _error = std::current_exception();
  }
}

/// Within a step.
bool OwnWork::asked_to_give_up() {
  guard([&] { _duties.attend(false); });
  return !_told_to_stop && (_error || _duties.stopping() || _watchdog.overdue());
}

bool OwnWork::report(const Progress& progress, const StateSource& state) {
  _times.arrived();
  _state = &state;
  guard([&] {
    note(progress);
    _duties.attend(true);
  });
  if (_error || _duties.stopping() || _watchdog.overdue()) tell_to_stop();
  _state = nullptr;
  _times.left();
  return !_told_to_stop;
}

/// Only once: afterwards the work may no longer be where it was.
void OwnWork::tell_to_stop() {
  if (_told_to_stop) return;
  _told_to_stop = true;
  guard([&] { _stopped_at = this->state(); });
}

void OwnWork::note(const Progress& progress) {
  _unshown_rows += progress.rows;
  _duties.count_rows(progress.rows);
  if (!_progress_interval.over()) return;
  _progress_interval.restart();
  Progress shown = progress;
  shown.rows = std::exchange(_unshown_rows, 0);
  _duties.tell(_key, shown);
}

void OwnWork::flush(const std::function<void(const std::string& key, const std::string& state)>& told,
                    const std::function<void()>& flush) {
  const bool under_way = !_key.empty();
  std::string here = state();
  if (under_way) told(_key, here);
  _watchdog.pause();
  const Stopwatch watch;
  flush();
  _watchdog.resume();
  if (!under_way) return;
  _times.flushed(watch.seconds());
  _flushed = true;
  _flushed_state = std::move(here);
}

}  // namespace orbweaver::queue
