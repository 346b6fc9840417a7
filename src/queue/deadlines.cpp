#include "deadlines.hpp"

namespace orbweaver::queue {

void Deadlines::began(int worker) {
  at(worker) = {};
  at(worker).busy = true;
}

void Deadlines::pause(int worker) {
  Watch& watch = at(worker);
  watch.used = watch.seconds();
  watch.paused = true;
}

void Deadlines::resume() {
  for (Watch& watch : _of) {
    watch.paused = false;
    watch.since.restart();
  }
}

std::vector<int> Deadlines::overdue() {
  std::vector<int> workers;
  if (_seconds <= 0) return workers;
  for (std::size_t rank = 0; rank < _of.size(); ++rank) {
    Watch& watch = _of[rank];
    if (!watch.busy || watch.told || watch.seconds() < _seconds) continue;
    watch.told = true;
    workers.push_back(static_cast<int>(rank));
  }
  return workers;
}

std::optional<int> Deadlines::unresponsive() const {
  for (std::size_t rank = 0; rank < _of.size() && _seconds > 0; ++rank)
    if (_of[rank].told && _of[rank].seconds() >= 2 * _seconds) return static_cast<int>(rank);
  return std::nullopt;
}

}  // namespace orbweaver::queue
