#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::loop {

/// What brings one loop closest to another: w(t) = M^-1 z(t + T shift), or M^-1 z(T shift - t) if reversing (as
/// `transformed`), and whole turns of the angles.
struct Alignment {
  std::string name;  ///< "1", that of the declared symmetry, or "RC" for the product of two
  bool reversing = false;
  systems::AffineMap map;
  double shift = 0.0;         ///< part of the period, in [0, 1)
  std::vector<double> turns;  ///< added to each coordinate afterwards, in whole turns of 2 pi (0 but for angles)
  double distance = std::numeric_limits<double>::infinity();  ///< sqrt of the mean over time of |w - to|^2
};

/// The element of the group that the declared symmetries generate, and the time shift, that bring `from` closest to
/// `to`, periods scaled to one: the first in the group's order, with the smallest shift either way, among those equally
/// close to 1e-12. The shift is a minimum of the distance to rounding. Where not even 119 harmonics of the loops in
/// time come closer than `hopeless`, that distance is returned. Infinite distance if the loops wind otherwise under
/// every symmetry. Throws MisuseError if dimensions differ.
[[nodiscard]] Alignment align(const systems::Structure& system, const Loop& from, const Loop& to,
                              double hopeless = std::numeric_limits<double>::infinity());

/// The time shift alone that brings `from` closest to `to`, a neighbour that winds alike: loops that begin nearly, not
/// quite, where they are nearest to each other, or in standard phase.
[[nodiscard]] Alignment align_in_time(const systems::Structure& system, const Loop& from, const Loop& to);

/// `from` (or a neighbour of it, with the same phase convention) moved by an alignment.
[[nodiscard]] Loop aligned(const Loop& from, const Alignment& alignment);

/// The largest m <= 12 such that the loop goes m times around a shorter one, to `tolerance` (rms over time of what has
/// not that period); windings must be divisible by m. 1 where there is none.
[[nodiscard]] int repetitions(const Loop& loop, double tolerance);

/// The loop of period T/m around which `loop` goes m times, under the identity as time map. What repeats less often is
/// left out. Throws MisuseError for m < 1 or windings that are not divisible by m.
[[nodiscard]] Loop without_repetition(const Loop& loop, int m);

}  // namespace orbweaver::loop
