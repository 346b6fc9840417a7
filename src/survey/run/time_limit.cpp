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

TimeLimit::TimeLimit(double scene, double wall) : _scene(scene), _wall(without_margin(wall)) {}

TimeLimit::~TimeLimit() {
  if (_reached) queue::clear_stop();
}

void TimeLimit::tick() {
  if (_reached || queue::stop_requested()) return;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - _began;
  if (passed.count() < std::min(_scene, _wall)) return;
  _reached = true;
  queue::request_stop();
}

std::string TimeLimit::remark(const queue::RunSummary& run) const {
  return fmt::format("stopped after {} = {:g} s: tasks cut short: {}, not begun: {}",
                     reached_scene() ? "limits.time" : "the wall time less its margin", std::min(_scene, _wall),
                     run.stopped, run.waiting - run.stopped);
}

}  // namespace orbweaver::survey
