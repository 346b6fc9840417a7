#pragma once

#include <chrono>
#include <limits>
#include <string>

#include "orbweaver/queue/run.hpp"

namespace orbweaver::survey {

/// The scene's limits.time and the program's wall time: asks the queue of this process to stop early
/// (queue::request_stop) once one of them has passed since the object was made. It ends a run and decides nothing else.
/// Only rank 0's counts.
class TimeLimit {
 public:
  /// Seconds. A run with a wall time is stopped a little earlier, so that there is time to end it.
  explicit TimeLimit(double scene, double wall = std::numeric_limits<double>::infinity());
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  /// Takes its own request back, so that a later run in this process is not stopped by it.
  ~TimeLimit();

  /// To be called from the observer's ticks.
  void tick();
  [[nodiscard]] bool reached() const noexcept { return _reached; }
  /// That it was the scene's: then the archive is wanted as it is.
  [[nodiscard]] bool reached_scene() const noexcept { return _reached && _scene <= _wall; }
  /// "stopped after limits.time = 60 s: tasks cut short: 2, not begun: 5", for the summary.
  [[nodiscard]] std::string remark(const queue::RunSummary& run) const;

 private:
  double _scene;
  double _wall;
  bool _reached = false;
  std::chrono::steady_clock::time_point _began = std::chrono::steady_clock::now();
};

}  // namespace orbweaver::survey
