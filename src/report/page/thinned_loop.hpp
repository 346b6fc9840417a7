#pragma once

#include <cstdint>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::report {

/// What a page has of an orbit besides the archive's columns.
struct ThinnedLoop {
  /// For t/T - s/(2 pi), then each coordinate less its winding: float64 step, float64 mean, count, then so many pairs
  /// of whole numbers; number times step are a_1, b_1, a_2, ... Then the spectrum: count of bins, harmonics a bin, and
  /// for each coordinate a byte a bin (spectrum_byte of the largest modulus in it). Counts are varints (LEB128), the
  /// pairs zigzag varints.
  std::vector<std::uint8_t> bytes;
  int harmonics = 0;            ///< the most that a coordinate has
  double deviation = 0.0;       ///< the largest from the loop itself at its nodes, in parts of a coordinate's range
  double amplitude = 0.0;       ///< rms over time of the distance from the mean
  std::vector<double> largest;  ///< of each coordinate over the orbit; NaN where it winds
};

/// The loop with as many harmonics and digits of each coordinate as keep it within `tolerance` times the coordinate's
/// range, measured at the nodes of loop::samples_of; the time, within `tolerance` of the period. Coordinates that
/// hardly move count with 1e-4 of the range of the one that moves most.
[[nodiscard]] ThinnedLoop thinned(const loop::Loop& loop, double tolerance);

/// The most bins of a spectrum; with more harmonics a bin is the largest of several.
inline constexpr int most_bins = 96;

/// log10 of a modulus in tenths, from 1e-20 on: 1 ... 255; 0: less.
[[nodiscard]] std::uint8_t spectrum_byte(double modulus);

}  // namespace orbweaver::report
