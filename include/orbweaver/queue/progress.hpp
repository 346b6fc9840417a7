#pragma once

#include <cstdint>
#include <vector>

namespace orbweaver::queue {

/// How far running work has come.
struct Progress {
  std::int64_t step = 0;       ///< steps done so far
  std::int64_t rows = 0;       ///< rows ready to be flushed that no earlier report has counted
  std::vector<double> values;  ///< a few numbers for the display (period, energy, ...); their meaning is the executor's

  friend bool operator==(const Progress&, const Progress&) = default;
};

}  // namespace orbweaver::queue
