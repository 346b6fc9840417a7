#pragma once

#include <functional>

namespace orbweaver::cost {

/// The median of the repetitions of something, in seconds of a steady clock.
struct Timing {
  double seconds = 0.0;
  int repetitions = 0;
};

/// Runs it once to warm up, then until `budget` seconds have passed, at least once and at most `most_repetitions`
/// times. What took longer than ten budgets the first time is not repeated: that time is the result.
[[nodiscard]] Timing timing_of(const std::function<void()>& work, double budget);

inline constexpr int most_repetitions = 101;

/// Seconds of one run.
[[nodiscard]] double seconds_of(const std::function<void()>& work);

}  // namespace orbweaver::cost
