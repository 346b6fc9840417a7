#include "orbweaver/loop/curve/time_samples.hpp"

#include <algorithm>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "resampled.hpp"

namespace orbweaver::loop {

namespace {

/// Each second one is there already.
TimeSamples twice_as_many(const TimeSamples& samples, const Loop& loop) {
  TimeSamples out = samples;
  out.count *= 2;
  out.states.resize(2 * samples.states.size());
  const std::vector<double> between = resampled(loop, {}, out.count, 1, 2);
  for (std::size_t m = 0; m < samples.states.size(); ++m) {
    out.states[2 * m] = samples.states[m];
    out.states[2 * m + 1] = between[m];
  }
  return out;
}

}  // namespace

TimeSamples time_samples(const Loop& loop, int count) {
  core::require(count >= 1, "samples in time need a count of at least 1");
  return {loop.dimension, count, loop.period, loop.winding, resampled(loop, {}, count)};
}

Loop interpolant(const TimeSamples& samples) {
  core::require(samples.count >= 4, "a loop's interpolant needs four samples or more");
  Loop out;
  out.dimension = samples.dimension;
  out.cutoff = samples.count % 2 == 0 ? samples.count / 2 - 1 : samples.count / 2;
  out.period = samples.period;
  out.winding = samples.winding;
  out.modes.resize((2 * static_cast<std::size_t>(out.cutoff) + 1) * static_cast<std::size_t>(out.dimension));
  FourierGrid::of_size(samples.count).analyze(out.cutoff, out.dimension, samples.states.data(), out.modes.data());
  return out;
}

Loop resolved_in_time(const Loop& loop, double negligible) {
  if (loop.time_map.is_identity()) return loop;
  const double allowed = std::max(negligible, 2.0 * tail(loop));
  TimeSamples samples = time_samples(loop, time_sample_count);
  for (;;) {
    Loop out = interpolant(samples);
    out.parameters = loop.parameters;
    if (tail(out) <= allowed || out.cutoff >= most_in_time * loop.cutoff) return out;
    samples = twice_as_many(samples, loop);
  }
}

}  // namespace orbweaver::loop
