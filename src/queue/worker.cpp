#include "worker.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backoff.hpp"
#include "guarded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/stop.hpp"
#include "overloaded.hpp"

namespace orbweaver::queue {

namespace {

constexpr double most_progress_messages_a_second = 1000.0;

double progress_seconds(const Options& options, int workers) {
  return std::max(options.progress_seconds, workers / most_progress_messages_a_second);
}

RunSummary summary_of(const Shutdown& shutdown) {
  RunSummary summary;
  summary.done = shutdown.done;
  summary.failed = shutdown.failed;
  summary.waiting = shutdown.waiting;
  summary.stopped = shutdown.stopped;
  summary.stopped_early = shutdown.stopped_early;
  summary.flushes = shutdown.flushes;
  summary.rows = shutdown.rows;
  summary.seconds = shutdown.seconds;
  return summary;
}

}  // namespace

Worker::Worker(const core::Communicator& comm, const Options& options, Executor& executor, Flusher& flusher)
    : _options(options),
      _executor(executor),
      _flusher(flusher),
      _channel(comm),
      _progress_interval(progress_seconds(options, comm.size() - 1)) {}

RunSummary Worker::run() {
  try {
    work();
  } catch (...) {
    _trouble = current_exception_text();
  }
  if (!_shutdown) {
    _channel.send(0, Alarm{_trouble});
    _shutdown = wait_for_shutdown();
  }
  part();
  if (!_shutdown->error.empty()) throw core::EnvironmentError(_shutdown->error);
  return summary_of(*_shutdown);
}

void Worker::work() {
  _channel.send(0, Hello{});
  while (!_shutdown && _trouble.empty()) {
    if (_task)
      do_task();
    else
      take(wait());
  }
}

void Worker::do_task() {
  _executing = true;
  _told_to_stop = _overdue = false;
  _stopped_at.clear();
  _flushed = false;
  _flushed_state = _task->state;
  _times.begin();
  auto [outcome, given_up] = execute_guarded(_executor, *_task, *this, [this] { return asked_to_give_up(); });
  if (given_up) {
    _executor.take_back_rows(_flushed);
    _told_to_stop = true;
    _stopped_at = _flushed_state;
  }
  _load.busy_seconds += _times.seconds();
  log_task(*_task, outcome, _times.seconds(), _times.silence());
  ++_load.tasks;
  outcome.stopped = _told_to_stop;
  outcome.state = std::move(_stopped_at);
  _executing = false;
  _task.reset();
  if (!_shutdown && _trouble.empty()) _channel.send(0, Outcome{std::move(outcome), std::exchange(_uncounted_rows, 0)});
  if (_waiting_flush && !_shutdown && _trouble.empty()) stand_still(*std::exchange(_waiting_flush, std::nullopt));
}

/// Within a step: a flush waits for its end.
bool Worker::asked_to_give_up() {
  try {
    pass_on_stop();
    while (!_shutdown && _trouble.empty()) {
      const auto received = _channel.poll();
      if (!received) break;
      const Message message = received->open();
      if (const auto* request = std::get_if<FlushRequest>(&message))
        _waiting_flush = request->number;
      else
        take(message);
    }
  } catch (...) {
    _trouble = current_exception_text();
  }
  return !_told_to_stop && (_stopping || _overdue || _shutdown || !_trouble.empty());
}

bool Worker::report(const Progress& progress, const StateSource& state_source) {
  _times.arrived();
  _state = &state_source;
  try {
    pass_on_stop();
    if (!_shutdown && _trouble.empty()) tell(progress);
    if (_waiting_flush && !_shutdown) stand_still(*std::exchange(_waiting_flush, std::nullopt));
    while (!_shutdown && _trouble.empty()) {
      const auto received = _channel.poll();
      if (!received) break;
      take(received->open());
    }
  } catch (...) {
    _trouble = current_exception_text();
  }
  if (_stopping || _overdue || _shutdown || !_trouble.empty()) tell_to_stop();
  _state = nullptr;
  _times.left();
  return !_told_to_stop;
}

/// Only once: afterwards the work may no longer be where it was.
void Worker::tell_to_stop() {
  if (_told_to_stop) return;
  _told_to_stop = true;
  try {
    _stopped_at = state();
  } catch (...) {
    if (_trouble.empty()) _trouble = current_exception_text();
  }
}

std::string Worker::state() const { return _state != nullptr && *_state ? (*_state)() : std::string(); }

/// A signal may reach a worker alone; rank 0 decides.
void Worker::pass_on_stop() {
  if (_passed_on || !stop_requested()) return;
  _passed_on = true;
  _channel.send(0, Stop{});
}

void Worker::tell(const Progress& progress) {
  _uncounted_rows += progress.rows;
  // While rank 0 has not taken the last message, another would only lengthen the line.
  if (!_progress_interval.over() || _channel.sending()) return;
  _progress_interval.restart();
  Progress counted = progress;
  counted.rows = std::exchange(_uncounted_rows, 0);
  _channel.send(0, ProgressReport{_task->key, std::move(counted)});
}

Message Worker::wait() {
  Backoff backoff(_options);
  for (;;) {
    if (const auto received = _channel.poll()) return received->open();
    pass_on_stop();
    if (_channel.sending()) backoff.reset();
    backoff.wait();
  }
}

Shutdown Worker::wait_for_shutdown() {
  Backoff backoff(_options);
  for (;;) {
    const auto received = _channel.poll();
    if (!received) {
      if (_channel.sending()) backoff.reset();
      backoff.wait();
      continue;
    }
    if (!received->is(Shutdown::tag)) continue;
    try {
      return std::get<Shutdown>(received->open());
    } catch (...) {
      Shutdown unreadable;
      unreadable.error = _trouble;
      return unreadable;
    }
  }
}

void Worker::part() {
  _channel.send(0, Goodbye{_load.tasks, _load.busy_seconds});
  Backoff backoff(_options);
  while (_channel.sending()) backoff.wait();
}

void Worker::take(const Message& message) {
  std::visit(
      Overloaded{
          [&](const Assign& assign) {
            if (_executing)
              throw core::EnvironmentError(fmt::format(
                  "rank 0 assigned task \"{}\" to a rank that was still doing \"{}\"", assign.task.key, _task->key));
            _task = assign.task;
          },
          [&](const FlushRequest& request) { stand_still(request.number); },
          [&](const Stop&) { _stopping = true; },
          // It may meet the outcome on its way: then it is for a task that is no longer here.
          [&](const EndTask& end) { _overdue |= _executing && end.key == _task->key; },
          [&](const Shutdown& shutdown) { _shutdown = shutdown; },
          [&](const auto& other) {
            throw core::EnvironmentError(
                fmt::format("a message \"{}\" came to a worker that did not expect one; the "
                            "protocol is broken",
                            tag_name(static_cast<int>(other.tag))));
          },
      },
      message);
}

void Worker::stand_still(int number) {
  const Stopwatch watch;
  const std::string here = state();
  _channel.send(0, FlushReady{number, std::exchange(_uncounted_rows, 0), here});
  bool go = false;
  while (!go && !_shutdown) {
    const Message message = wait();
    if (const auto* flush_go = std::get_if<FlushGo>(&message); flush_go != nullptr && flush_go->number == number)
      go = true;
    else if (std::holds_alternative<Stop>(message) || std::holds_alternative<EndTask>(message) ||
             std::holds_alternative<Shutdown>(message))
      take(message);
    else
      throw core::EnvironmentError(
          fmt::format("a message \"{}\" came to a worker that waited to begin flush {}; the protocol is "
                      "broken",
                      tag_name(static_cast<int>(tag_of(message))), number));
  }
  if (go) {
    flush(number);
    _flushed = true;
    _flushed_state = here;
  }
  _times.flushed(watch.seconds());
}

void Worker::flush(int number) {
  const std::string error = flush_guarded(_flusher, number);
  if (!error.empty()) _stopping = true;
  _channel.send(0, FlushDone{number, error});
}

}  // namespace orbweaver::queue
