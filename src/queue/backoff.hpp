#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/queue/run.hpp"

namespace orbweaver::queue {

/// How a rank waits: each sleep is a quarter longer than the one before, up to the longest, so that a message is seen
/// after about a fifth of the time it took to come.
class Backoff {
 public:
  explicit Backoff(const Options& options)
      : _shortest(options.shortest_sleep), _longest(options.longest_sleep), _next(_shortest) {}

  void wait() {
    const core::LogStage stage(core::Stage::queue_wait);
    std::this_thread::sleep_for(_next);
    _next = std::min(_next + (_next + std::chrono::microseconds(3)) / 4, _longest);
  }
  void reset() { _next = _shortest; }

 private:
  std::chrono::microseconds _shortest;
  std::chrono::microseconds _longest;
  std::chrono::microseconds _next;
};

}  // namespace orbweaver::queue
