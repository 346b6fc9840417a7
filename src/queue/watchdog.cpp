#include "watchdog.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "guarded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"

namespace orbweaver::queue {

namespace {

/// Between two looks at the clock: a tenth of a second, which costs nothing, or a quarter of shorter limits.
constexpr double longest_look = 0.1;
constexpr double looks_a_limit = 4.0;

}  // namespace

Watchdog::Watchdog(double task_seconds) : _seconds(task_seconds), _deadlines(task_seconds, 1) {
  if (_seconds > 0) _thread = std::thread([this] { watch(); });
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(_mutex);
    _over = true;
  }
  _woken.notify_all();
  if (_thread.joinable()) _thread.join();
}

void Watchdog::began(const std::string& key) {
  const std::lock_guard lock(_mutex);
  _key = key;
  _deadlines.began(0);
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
  const std::chrono::duration<double> interval(std::min(longest_look, _seconds / looks_a_limit));
  std::unique_lock lock(_mutex);
  while (!_woken.wait_for(lock, interval, [this] { return _over; })) {
    static_cast<void>(_deadlines.overdue());
    if (!_deadlines.unresponsive()) continue;
    core::log_error(unresponsive_text(_key, 0, _seconds));
    std::_Exit(static_cast<int>(core::ExitStatus::environment_failed));  // the task's thread will not end by itself
  }
}

}  // namespace orbweaver::queue
