#pragma once

#include <optional>
#include <vector>

#include "interval.hpp"

namespace orbweaver::queue {

/// Rank 0's watch over how long the workers take for their tasks, without the time they stand still for flushes. A task
/// has `seconds` to end by itself, and the same again to obey when its worker is told to end it. 0: no limit.
class Deadlines {
 public:
  Deadlines(double seconds, int ranks) : _seconds(seconds), _of(static_cast<std::size_t>(ranks)) {}

  void began(int worker);
  void ended(int worker) { at(worker) = {}; }
  void pause(int worker);
  /// All go on from a flush.
  void resume();

  /// Workers whose time is over and who have not been told before; they now count as told.
  [[nodiscard]] std::vector<int> overdue();
  [[nodiscard]] bool told(int worker) const { return _of[static_cast<std::size_t>(worker)].told; }
  /// A worker who was told and has not ended its task in time.
  [[nodiscard]] std::optional<int> unresponsive() const;

 private:
  struct Watch {
    bool busy = false;
    bool told = false;
    bool paused = false;
    double used = 0.0;  // before `since` was restarted
    Stopwatch since;

    [[nodiscard]] double seconds() const { return paused ? used : used + since.seconds(); }
  };
  Watch& at(int worker) { return _of[static_cast<std::size_t>(worker)]; }

  double _seconds;
  std::vector<Watch> _of;  // by rank
};

}  // namespace orbweaver::queue
