#include "watchdog.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "guarded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/queue/stop.hpp"

namespace orbweaver::queue {

namespace {

/// Between two looks at the clock: a tenth of a second, which costs nothing, or a quarter of shorter limits.
constexpr double longest_look = 0.1;
constexpr double looks_a_limit = 4.0;

double interval_of(double task_seconds, double stop_seconds) {
  double interval = longest_look;
  for (const double limit : {task_seconds, stop_seconds})
    if (limit > 0.0) interval = std::min(interval, limit / looks_a_limit);
  return task_seconds > 0.0 || stop_seconds > 0.0 ? interval : 0.0;
}

}  // namespace

Watchdog::Watchdog(double task_seconds, double stop_seconds)
    : _interval(interval_of(task_seconds, stop_seconds)), _deadlines(task_seconds, stop_seconds, 1) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(_mutex);
    _over = true;
  }
  _woken.notify_all();
  if (_thread.joinable()) _thread.join();
}

void Watchdog::began(const std::string& work) {
  const std::lock_guard lock(_mutex);
  _work = work;
  _deadlines.began(0);
  if (_interval > 0.0 && !_thread.joinable()) _thread = std::thread([this] { watch(); });
}

void Watchdog::alive() {
  const std::lock_guard lock(_mutex);
  _deadlines.alive(0);
}

void Watchdog::ended() {
  const std::lock_guard lock(_mutex);
  _deadlines.ended(0);
}

void Watchdog::pause() {
  const std::lock_guard lock(_mutex);
  _deadlines.pause(0);
}

void Watchdog::resume() {
  const std::lock_guard lock(_mutex);
  _deadlines.resume();
}

bool Watchdog::overdue() {
  const std::lock_guard lock(_mutex);
  static_cast<void>(_deadlines.overdue());
  return _deadlines.told(0);
}

void Watchdog::watch() {
  const std::chrono::duration<double> interval(_interval);
  std::unique_lock lock(_mutex);
  while (!_woken.wait_for(lock, interval, [this] { return _over; })) {
    static_cast<void>(_deadlines.overdue());
    if (stop_requested()) _deadlines.stop();
    const auto found = _deadlines.unresponsive();
    if (!found) continue;
    core::log_error(unresponsive_text(_work, *found));
    std::_Exit(static_cast<int>(core::ExitStatus::environment_failed));  // the work's thread will not end by itself
  }
}

}  // namespace orbweaver::queue
