#pragma once

#include <functional>

namespace orbweaver::core {

/// Thrown by interruption_point. No std::exception: what handles failures must not take a stop for one.
struct Interrupted {};

/// While the innermost of these stands on this thread, interruption_point asks it whether the work is to be given up.
/// One that asks nothing (an empty function) keeps work whole that others wait for in a collective.
class InterruptionScope {
 public:
  explicit InterruptionScope(std::function<bool()> asked);
  InterruptionScope(const InterruptionScope&) = delete;
  InterruptionScope& operator=(const InterruptionScope&) = delete;
  ~InterruptionScope();

 private:
  friend void interruption_point();
  std::function<bool()> _asked;
  InterruptionScope* _outer;
};

/// To be called in the loops of work that may take longer than a second, every millisecond or so; costs nanoseconds.
/// Throws Interrupted when the innermost scope says so; it is asked every few milliseconds.
void interruption_point();

}  // namespace orbweaver::core
