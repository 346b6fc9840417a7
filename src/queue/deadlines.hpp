#pragma once

#include <optional>
#include <vector>

#include "interval.hpp"

namespace orbweaver::queue {

/// Watches over how long ranks take for their tasks, without the time they stand still for flushes. A task has
/// `task_seconds` to end by itself, and the same again to obey when it is told to end; and `stop_seconds` to obey when
/// the run is to stop. 0: no limit.
class Deadlines {
 public:
  Deadlines(double task_seconds, double stop_seconds, int ranks)
      : _task_seconds(task_seconds), _stop_seconds(stop_seconds), _of(static_cast<std::size_t>(ranks)) {}

  void began(int rank);
  void ended(int rank) { at(rank) = {}; }
  void pause(int rank);
  /// All go on from a flush.
  void resume();
  /// The run is to stop: tasks have stop_seconds from the first call on.
  void stop();
  /// A sign of life of work that may go on although the run is to stop: it has stop_seconds anew.
  void alive(int rank);

  /// Ranks whose task's time is over and who have not been told before; they now count as told.
  [[nodiscard]] std::vector<int> overdue();
  [[nodiscard]] bool told(int rank) const { return at(rank).told; }
  /// A task that has not ended in the time that it had to obey.
  struct Unresponsive {
    int rank = 0;
    double seconds = 0.0;   ///< that it had
    bool stopping = false;  ///< since the run was to stop; else since its own time was over
  };
  [[nodiscard]] std::optional<Unresponsive> unresponsive() const;

 private:
  struct Watch {
    bool busy = false;
    bool told = false;
    bool paused = false;
    double used = 0.0;  // before `since` was restarted
    Stopwatch since;
    std::optional<double> stopped;  // seconds() when the run was to stop

    [[nodiscard]] double seconds() const { return paused ? used : used + since.seconds(); }
  };
  Watch& at(int rank) { return _of[static_cast<std::size_t>(rank)]; }
  [[nodiscard]] const Watch& at(int rank) const { return _of[static_cast<std::size_t>(rank)]; }

  double _task_seconds;
  double _stop_seconds;
  std::vector<Watch> _of;  // by rank
};

}  // namespace orbweaver::queue
