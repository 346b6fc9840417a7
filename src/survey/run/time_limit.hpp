#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <string>
#include <thread>

#include "orbweaver/queue/run.hpp"

namespace orbweaver::survey {

/// The scene's limits.time and the program's wall time: asks the queue of this process to stop early
/// (queue::request_stop) once one of them has passed, by a thread of its own, so that a task that never reports cannot
/// keep it from that. It ends a run and decides nothing else. One is needed, that of rank 0.
class TimeLimit {
 public:
  using Clock = std::chrono::steady_clock;
  /// Seconds since `began`. A run with a wall time is stopped a little earlier, so that there is time to end it.
  explicit TimeLimit(double scene, double wall = std::numeric_limits<double>::infinity(),
                     Clock::time_point began = Clock::now());
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  /// Takes its own request back, so that a later run in this process is not stopped by it.
  ~TimeLimit();

  /// Asks for no stop any more.
  void end();
  [[nodiscard]] bool reached() const noexcept { return _reached; }
  /// That it was the scene's: then the archive is wanted as it is.
  [[nodiscard]] bool reached_scene() const noexcept { return _reached && _scene <= _wall; }
  /// "stopped after limits.time = 60 s: tasks cut short: 2, not begun: 5", for the summary.
  [[nodiscard]] std::string remark(const queue::RunSummary& run) const;

 private:
  double _scene;
  double _wall;
  std::atomic<bool> _reached{false};
  std::mutex _mutex;
  std::condition_variable _woken;
  bool _over = false;
  std::thread _thread;
};

}  // namespace orbweaver::survey
