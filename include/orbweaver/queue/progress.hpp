#pragma once

#include <cstdint>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::queue {

/// How far running work has come.
struct Progress {
  std::int64_t step = 0;       ///< steps done so far
  std::int64_t rows = 0;       ///< rows ready to be flushed that no earlier report has counted
  std::vector<double> values;  ///< a few numbers for the display (period, energy, ...); their meaning is the executor's

  friend bool operator==(const Progress&, const Progress&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, step, rows, values);
  }
};

}  // namespace orbweaver::queue
