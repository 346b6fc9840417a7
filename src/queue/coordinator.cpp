#include "coordinator.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backoff.hpp"
#include "guarded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/queue/stop.hpp"
#include "overloaded.hpp"

namespace orbweaver::queue {

Coordinator::Coordinator(const core::Communicator& comm, const Options& options, Executor& executor, Observer& observer,
                         Flusher& flusher)
    : _comm(comm),
      _options(options),
      _flusher(flusher),
      _channel(comm),
      _ledger(options, comm.size(), observer),
      _works(comm.size() <= std::max(1, options.root_works_up_to)),
      _own(options, executor, *this),
      _schedule(options, _works ? comm.size() : comm.size() - 1),
      _round(comm.size()),
      _deadlines(options.task_seconds, options.stop_seconds, comm.size()),
      _task_of(static_cast<std::size_t>(comm.size())),
      _greeted(static_cast<std::size_t>(comm.size()), false) {}

RunSummary Coordinator::run(std::vector<Task> initial) {
  std::string error;
  try {
    _ledger.add(std::move(initial));
    serve();
  } catch (...) {
    error = run_ended_text(current_exception_text());
  }
  part(error);
  if (!error.empty()) throw core::EnvironmentError(error);
  return _ledger.close();
}

void Coordinator::serve() {
  Backoff backoff(_options);
  while (!_over) {
    const bool busy = attended(true) || work_itself();
    const bool sending = _channel.sending();
    if (busy || sending) backoff.reset();
    if (!busy) backoff.wait();
  }
}

/// What others want of rank 0, and the observer. Whether there was anything.
bool Coordinator::attended(bool stands) {
  bool busy = receive_some();
  busy |= pass_on_stop();
  busy |= check_deadlines();
  while (!_over && advance_flush(stands)) busy = true;
  busy |= hand_out();
  _ledger.tick();
  return busy;
}

bool Coordinator::receive_some() {
  // Bounded, so that a flood cannot keep rank 0 from its other duties.
  const int most = 4 * _comm.size();
  for (int count = 0; count < most; ++count) {
    const auto received = _channel.poll();
    if (!received) return count > 0;
    accept(received->source, received->open());
  }
  return true;
}

bool Coordinator::pass_on_stop() {
  if (_stopping || !stop_requested()) return false;
  _stopping = true;
  _channel.send_to_workers(Stop{});
  _deadlines.stop();
  return true;
}

bool Coordinator::check_deadlines() {
  if (const auto found = _deadlines.unresponsive()) {
    // It cannot be asked to take part in an orderly end.
    core::log_error(unresponsive_text(task_text(_task_of[static_cast<std::size_t>(found->rank)], found->rank), *found));
    MPI_Abort(_comm.get(), static_cast<int>(core::ExitStatus::environment_failed));
  }
  const std::vector<int> workers = _deadlines.overdue();
  for (const int worker : workers) _channel.send(worker, EndTask{_task_of[static_cast<std::size_t>(worker)]});
  return !workers.empty();
}

bool Coordinator::work_over() const {
  return _ledger.counts().running == 0 && (_stopping || _ledger.counts().waiting == 0);
}

/// Unless rank 0 stands, nobody is asked to: others would wait for the end of its step.
bool Coordinator::advance_flush(bool stands) {
  switch (_round.phase()) {
    case FlushRound::Phase::none:
      if (!stands || (!work_over() && !_schedule.due())) return false;
      _round.request();
      _schedule.begun();
      _channel.send_to_workers(FlushRequest{_round.number()});
      return true;
    case FlushRound::Phase::gathering:
      if (!stands || !_round.complete()) return false;
      flush_together();
      return true;
    case FlushRound::Phase::flushing:
      if (!_round.complete()) return false;
      end_flush();
      return true;
  }
  return false;
}

void Coordinator::flush_together() {
  _last_round = work_over();
  const int number = _round.number();
  _own.flush([&](const std::string& key, const std::string& state) { _ledger.set_state(key, state); },
             [&] {
               _ledger.flushing(number);
               _channel.send_to_workers(FlushGo{number});
               _round.go();
               _round.own_result(flush_guarded(_flusher, number));
             });
}

void Coordinator::end_flush() {
  const int number = _round.number();
  _round.end();
  _ledger.flushed(number);
  _schedule.flushed();
  _deadlines.resume();
  _over = _last_round;
}

bool Coordinator::hand_out() {
  // None during a flush: a worker that stands still would only let the task wait.
  if (_stopping || _round.phase() != FlushRound::Phase::none) return false;
  bool any = false;
  while (!_idle.empty() && _ledger.counts().waiting > 0) {
    any = true;
    const int worker = *_idle.begin();
    const Task* const task = _ledger.start(worker);
    if (task == nullptr) break;
    _task_of[static_cast<std::size_t>(worker)] = task->key;
    _idle.erase(_idle.begin());
    _deadlines.began(worker);
    _channel.send(worker, Assign{*task});
  }
  return any;
}

bool Coordinator::work_itself() {
  if (!_works || _stopping || _round.phase() != FlushRound::Phase::none || _ledger.counts().waiting == 0) return false;
  const Task* const next = _ledger.start(0);
  if (next == nullptr) return true;
  const Task task = *next;  // the ledger's gets the states of flushes
  OwnWork::Done done = _own.execute(task);
  _ledger.settle(std::move(done.outcome), done.overdue);
  return true;
}

void Coordinator::count_rows(std::int64_t rows) {
  _schedule.count(rows);
  _ledger.count_rows(rows);
}

void Coordinator::accept(int worker, Message&& message) {
  std::visit(
      Overloaded{
          [&](const Hello& hello) { accept(worker, hello); },
          [&](Outcome& outcome) { accept(worker, std::move(outcome)); },
          [&](const ProgressReport& report) { accept(worker, report); },
          [&](const FlushReady& ready) {
            _round.ready(worker, ready.number);
            _deadlines.pause(worker);
            count_rows(ready.rows);
            const std::string& key = _task_of[static_cast<std::size_t>(worker)];
            if (!key.empty()) _ledger.set_state(key, ready.state);
          },
          [&](const FlushDone& done) { _round.done(worker, done.number, done.error); },
          [&](const Stop&) { request_stop(); },
          [&](const Alarm& alarm) { throw core::EnvironmentError(fmt::format("rank {}: {}", worker, alarm.error)); },
          [&](const auto& other) { refuse(worker, other.tag); },
      },
      message);
}

void Coordinator::accept(int worker, const Hello& hello) {
  if (hello.version != protocol_version)
    throw core::EnvironmentError(
        fmt::format("rank {} speaks version {} of the queue's protocol and rank 0 version {}; start all "
                    "ranks with the same orbweaver",
                    worker, hello.version, protocol_version));
  if (_greeted[static_cast<std::size_t>(worker)]) refuse(worker, Hello::tag);
  _greeted[static_cast<std::size_t>(worker)] = true;
  _idle.insert(worker);
}

void Coordinator::accept(int worker, Outcome&& outcome) {
  std::string& key = _task_of[static_cast<std::size_t>(worker)];
  if (key.empty() || outcome.outcome.key != key) refuse(worker, Outcome::tag);
  const bool overdue = _deadlines.told(worker);
  _deadlines.ended(worker);
  key.clear();
  _idle.insert(worker);
  count_rows(outcome.rows);
  _ledger.settle(std::move(outcome.outcome), overdue);
}

void Coordinator::accept(int worker, const ProgressReport& report) {
  const std::string& key = _task_of[static_cast<std::size_t>(worker)];
  if (key.empty() || report.key != key) refuse(worker, ProgressReport::tag);
  count_rows(report.progress.rows);
  _ledger.report(key, report.progress, worker);
}

void Coordinator::refuse(int worker, Tag tag) const {
  const std::string& key = _task_of[static_cast<std::size_t>(worker)];
  throw core::EnvironmentError(fmt::format(
      "rank {} sent a message \"{}\" that does not fit what it is doing ({}); the protocol is broken", worker,
      tag_name(static_cast<int>(tag)), key.empty() ? "it has no task" : fmt::format("it has task \"{}\"", key)));
}

void Coordinator::part(const std::string& error) {
  _ledger.set_load(0, _own.load());
  if (!error.empty()) core::log_debug(fmt::format("queue: shutting down: {}", error));
  const RunSummary now = _ledger.numbers();
  _channel.send_to_workers(Shutdown{error, now.done, now.failed, now.waiting, now.stopped, now.stopped_early,
                                    now.flushes, now.rows, now.seconds});
  _deadlines.stop();
  Backoff backoff(_options);
  int goodbyes = 0;
  while (goodbyes < _comm.size() - 1 || _channel.sending()) {
    const auto received = _channel.poll();
    if (!received) {
      check_deadlines();
      backoff.wait();
      continue;
    }
    backoff.reset();
    if (received->is(Outcome::tag) || received->is(Goodbye::tag)) _deadlines.ended(received->source);
    if (!received->is(Goodbye::tag)) continue;
    ++goodbyes;
    note_load(*received);
  }
}

void Coordinator::note_load(const Received& received) {
  try {
    const auto goodbye = std::get<Goodbye>(received.open());
    _ledger.set_load(received.source, {goodbye.tasks, goodbye.busy_seconds});
  } catch (const core::EnvironmentError& error) {
    core::log_warning(error.what());
  }
}

}  // namespace orbweaver::queue
