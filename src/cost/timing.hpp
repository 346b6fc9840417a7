#pragma once

#include <functional>
#include <limits>

#include "orbweaver/core/error.hpp"

namespace orbweaver::cost {

/// What took longer than it was given.
struct GivenUp : core::NumericalError {
  using NumericalError::NumericalError;
};

/// Runs it, and ends it at its next interruption point once it has taken so many seconds: throws GivenUp.
void run_within(double patience, const std::function<void()>& work);

/// The median of the repetitions of something, in seconds of a steady clock.
struct Timing {
  double seconds = 0.0;
  int repetitions = 0;
};

/// Runs it once to warm up, then until `budget` seconds have passed, at least once and at most `most_repetitions`
/// times. What took longer than ten budgets the first time is not repeated: that time is the result. Throws GivenUp
/// after `patience` seconds of the first run.
[[nodiscard]] Timing timing_of(const std::function<void()>& work, double budget,
                               double patience = std::numeric_limits<double>::infinity());

inline constexpr int most_repetitions = 101;

/// Seconds of one run.
[[nodiscard]] double seconds_of(const std::function<void()>& work);

}  // namespace orbweaver::cost
