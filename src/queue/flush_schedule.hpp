#pragma once

#include <cstdint>

#include "interval.hpp"
#include "orbweaver/queue/run.hpp"

namespace orbweaver::queue {

/// When the next flush is due: by time or by rows, whichever comes first.
class FlushSchedule {
 public:
  explicit FlushSchedule(const Options& options)
      : _by_time(options.flush_seconds > 0), _most_rows(options.flush_rows), _interval(options.flush_seconds) {}

  void count(std::int64_t rows) { _rows += rows; }
  [[nodiscard]] bool due() const { return (_by_time && _interval.over()) || (_most_rows > 0 && _rows >= _most_rows); }
  void flushed() {
    _rows = 0;
    _interval.restart();
  }

 private:
  bool _by_time;
  std::int64_t _most_rows;
  std::int64_t _rows = 0;
  Interval _interval;
};

}  // namespace orbweaver::queue
