#include "time_limit.hpp"

#include <fmt/format.h>

#include "orbweaver/queue/stop.hpp"

namespace orbweaver::survey {

TimeLimit::~TimeLimit() {
  if (_reached) queue::clear_stop();
}

void TimeLimit::tick() {
  if (_reached) return;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - _began;
  if (passed.count() < _seconds) return;
  _reached = true;
  queue::request_stop();
}

std::string TimeLimit::remark(const queue::RunSummary& run) const {
  return fmt::format("stopped after limits.time = {:g} s: tasks cut short: {}, not begun: {}", _seconds, run.stopped,
                     run.waiting - run.stopped);
}

}  // namespace orbweaver::survey
