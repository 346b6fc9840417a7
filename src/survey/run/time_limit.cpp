#include "time_limit.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/queue/stop.hpp"

namespace orbweaver::survey {

namespace {

/// What is left of a wall time for the last flush: this share, and so many seconds at most. Not measured;
/// a flush that comes too late is killed by the batch system, and the resume begins at the one before.
constexpr double margin_share = 0.05;
constexpr double largest_margin = 60.0;

double without_margin(double wall) { return wall - std::min(margin_share * wall, largest_margin); }

}  // namespace

TimeLimit::TimeLimit(double scene, double wall, Clock::time_point began) : _scene(scene), _wall(without_margin(wall)) {
  const std::chrono::duration<double> limit(std::min(_scene, _wall));
  if (limit >= Clock::time_point::max() - began) return;  // never
  const auto until = began + std::chrono::ceil<Clock::duration>(limit);
  _thread = std::thread([this, until] {
    std::unique_lock lock(_mutex);
    if (_woken.wait_until(lock, until, [this] { return _over; }) || queue::stop_requested()) return;
    _reached = true;
    queue::request_stop();
  });
}

TimeLimit::~TimeLimit() {
  end();
  if (_reached) queue::clear_stop();
}

void TimeLimit::end() {
  {
    const std::lock_guard lock(_mutex);
    _over = true;
  }
  _woken.notify_all();
  if (_thread.joinable()) _thread.join();
}

std::string TimeLimit::remark(const queue::RunSummary& run) const {
  return fmt::format("stopped after {} = {:g} s: tasks cut short: {}, not begun: {}",
                     reached_scene() ? "limits.time" : "the wall time less its margin", std::min(_scene, _wall),
                     run.stopped, run.waiting - run.stopped);
}

}  // namespace orbweaver::survey
