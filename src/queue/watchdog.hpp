#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "deadlines.hpp"

namespace orbweaver::queue {

/// Minds Options::task_seconds and stop_seconds for work of this process that nobody else watches, as the tasks of rank
/// 0: a thread that ends the program with status 3 when the work neither ends nor reports. It begins with the first
/// work, and only where there is a limit.
class Watchdog {
 public:
  Watchdog(double task_seconds, double stop_seconds);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  Watchdog(Watchdog&&) = delete;
  Watchdog& operator=(Watchdog&&) = delete;
  ~Watchdog();

  /// `work` is what messages call it.
  void began(const std::string& work);
  void ended();
  /// Of work that may go on after a stop was asked for.
  void alive();
  void pause();
  void resume();
  /// Whether the time of the task is over.
  [[nodiscard]] bool overdue();

 private:
  void watch();

  double _interval;  // s, between two looks; 0: there is no limit
  std::mutex _mutex;
  std::condition_variable _woken;
  bool _over = false;
  std::string _work;
  Deadlines _deadlines;
  std::thread _thread;
};

}  // namespace orbweaver::queue
