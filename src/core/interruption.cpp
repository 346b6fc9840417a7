#include "orbweaver/core/interruption.hpp"

#include <chrono>
#include <utility>

namespace orbweaver::core {

namespace {

using Clock = std::chrono::steady_clock;

/// Between two questions, which may look for messages: a worker may wait for a task from a rank 0 that works itself. An
/// empty look takes a microsecond.
constexpr std::chrono::milliseconds interval{2};

thread_local InterruptionScope* innermost = nullptr;
thread_local Clock::time_point last_asked;

}  // namespace

InterruptionScope::InterruptionScope(std::function<bool()> asked)
    : _asked(std::move(asked)), _outer(std::exchange(innermost, this)) {
  last_asked = Clock::now();
}

InterruptionScope::~InterruptionScope() { innermost = _outer; }

void interruption_point() {
  if (innermost == nullptr || !innermost->_asked) return;
  const Clock::time_point now = Clock::now();
  if (now - last_asked < interval) return;
  last_asked = now;
  if (innermost->_asked()) throw Interrupted{};
}

}  // namespace orbweaver::core
