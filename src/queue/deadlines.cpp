#include "deadlines.hpp"

namespace orbweaver::queue {

void Deadlines::began(int rank) {
  at(rank) = {};
  at(rank).busy = true;
}

void Deadlines::pause(int rank) {
  Watch& watch = at(rank);
  watch.used = watch.seconds();
  watch.paused = true;
}

void Deadlines::resume() {
  for (Watch& watch : _of) {
    watch.paused = false;
    watch.since.restart();
  }
}

void Deadlines::stop() {
  for (Watch& watch : _of)
    if (watch.busy && !watch.stopped) watch.stopped = watch.seconds();
}

void Deadlines::alive(int rank) {
  Watch& watch = at(rank);
  if (watch.stopped) watch.stopped = watch.seconds();
}

std::vector<int> Deadlines::overdue() {
  std::vector<int> ranks;
  if (_task_seconds <= 0) return ranks;
  for (std::size_t rank = 0; rank < _of.size(); ++rank) {
    Watch& watch = _of[rank];
    if (!watch.busy || watch.told || watch.seconds() < _task_seconds) continue;
    watch.told = true;
    ranks.push_back(static_cast<int>(rank));
  }
  return ranks;
}

std::optional<Deadlines::Unresponsive> Deadlines::unresponsive() const {
  for (std::size_t n = 0; n < _of.size(); ++n) {
    const int rank = static_cast<int>(n);
    const Watch& watch = _of[n];
    if (watch.told && watch.seconds() >= 2 * _task_seconds) return Unresponsive{rank, _task_seconds, false};
    if (_stop_seconds > 0 && watch.stopped && watch.seconds() >= *watch.stopped + _stop_seconds)
      return Unresponsive{rank, _stop_seconds, true};
  }
  return std::nullopt;
}

}  // namespace orbweaver::queue
