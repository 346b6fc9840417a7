#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// States of a loop at times T j / count, j = 0 ... count - 1, less the winding's n 2 pi j / count.
struct TimeSamples {
  int dimension = 0;
  int count = 0;
  double period = 0.0;
  std::vector<double> winding;  ///< n, size dimension
  std::vector<double> states;   ///< dimension x count, component-major
};

/// 240 = 2^4 3 5: shifts by 1/2, 1/3, 1/4, 1/5, 1/6, 1/8, 1/10 and 1/12 of a period are shifts of the index.
inline constexpr int time_sample_count = 240;

/// The samples under whatever time map the loop has. Cost O(count x cutoff x dimension). Throws MisuseError for count <
/// 1.
[[nodiscard]] TimeSamples time_samples(const Loop& loop, int count = time_sample_count);

/// The trigonometric interpolant of the samples, under the identity as time map: the loop's harmonics in time below
/// count / 2 as long as it has no higher ones; those are added to lower ones (aliased). Shifts by whole samples are
/// exact all the same. Throws MisuseError for count < 4.
[[nodiscard]] Loop interpolant(const TimeSamples& samples);

/// The loop with s even in time: itself, or the interpolant of 240, 480, ... samples, as many as it takes for its tail
/// to stay below twice that of the loop or `negligible`, and up to `most_in_time` times its harmonics. As
/// `evenly_in_time`, but cheaper.
[[nodiscard]] Loop resolved_in_time(const Loop& loop, double negligible = negligible_harmonic);

}  // namespace orbweaver::loop
