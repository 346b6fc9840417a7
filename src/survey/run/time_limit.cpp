#include "time_limit.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/queue/stop.hpp"

namespace orbweaver::survey {

namespace {

/// What is left of a wall time for the last flush: a twentieth, a minute at most.
double without_margin(double wall) { return wall - std::min(0.05 * wall, 60.0); }

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
