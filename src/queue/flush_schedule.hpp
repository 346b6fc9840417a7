#pragma once

#include <algorithm>
#include <cstdint>

#include "interval.hpp"
#include "orbweaver/queue/run.hpp"

namespace orbweaver::queue {

/// When the next flush is due: by time or by rows, whichever comes first, but not so often that flushes take more than
/// their share of the run. It is not put off where the ranks that work hold `flush_rows` each: memory stays bounded.
class FlushSchedule {
 public:
  FlushSchedule(const Options& options, int workers) : _options(options), _workers(workers) {}

  void count(std::int64_t rows) { _rows += rows; }
  [[nodiscard]] bool due() const {
    const double since = _since_flush.seconds();
    const bool by_time = _options.flush_seconds > 0 && since >= _options.flush_seconds;
    const bool by_rows = _options.flush_rows > 0 && _rows >= _options.flush_rows;
    if (by_rows && _rows >= _workers * _options.flush_rows) return true;
    return (by_time || by_rows) && since >= _rest;
  }
  /// Ranks begin to stand still for a flush, and go on from it.
  void begun() { _since_begun.restart(); }
  void flushed() {
    _rest = std::min(_since_begun.seconds() / _options.flush_share, longest_rest * _options.flush_seconds);
    _rows = 0;
    _since_flush.restart();
  }

 private:
  static constexpr double longest_rest = 10.0;  // in flush_seconds: what a crash may lose

  const Options& _options;
  int _workers;
  std::int64_t _rows = 0;
  double _rest = 0.0;
  Stopwatch _since_flush;
  Stopwatch _since_begun;
};

}  // namespace orbweaver::queue
