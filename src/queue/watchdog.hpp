#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "deadlines.hpp"

namespace orbweaver::queue {

/// Minds Options::task_seconds for the tasks of rank 0, which nobody else watches: a thread that ends the program when
/// a task neither ends nor reports. Without a limit there is no thread.
class Watchdog {
 public:
  explicit Watchdog(double task_seconds);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  Watchdog(Watchdog&&) = delete;
  Watchdog& operator=(Watchdog&&) = delete;
  ~Watchdog();

  void began(const std::string& key);
  void ended();
  void pause();
  void resume();
  /// Whether the time of the task is over.
  [[nodiscard]] bool overdue();

 private:
  void watch();

  double _seconds;
  std::mutex _mutex;
  std::condition_variable _woken;
  bool _over = false;
  std::string _key;
  Deadlines _deadlines;
  std::thread _thread;
};

}  // namespace orbweaver::queue
