#pragma once

#include <chrono>

namespace orbweaver::queue {

/// Seconds since a moment.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - _start).count(); }
  void restart() { _start = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point _start = Clock::now();
};

/// Says when a number of seconds has passed since the last restart.
class Interval {
 public:
  explicit Interval(double seconds) : _seconds(seconds) {}
  [[nodiscard]] bool over() const { return _since.seconds() >= _seconds; }
  void restart() { _since.restart(); }

 private:
  double _seconds;
  Stopwatch _since;
};

}  // namespace orbweaver::queue
