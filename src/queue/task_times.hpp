#pragma once

#include <algorithm>

#include "interval.hpp"

namespace orbweaver::queue {

/// The times of the task that this rank does, without its flushes.
class TaskTimes {
 public:
  void begin() { *this = TaskTimes(); }
  /// The work has come to a report, and goes on from it.
  void arrived() { _silence = std::max(_silence, _since_report.seconds()); }
  void left() { _since_report.restart(); }
  void flushed(double seconds) { _flushes += seconds; }

  [[nodiscard]] double seconds() const { return _since_begin.seconds() - _flushes; }
  /// The longest time so far without a report.
  [[nodiscard]] double silence() const { return std::max(_silence, _since_report.seconds()); }

 private:
  Stopwatch _since_begin;
  Stopwatch _since_report;
  double _silence = 0.0;
  double _flushes = 0.0;
};

}  // namespace orbweaver::queue
