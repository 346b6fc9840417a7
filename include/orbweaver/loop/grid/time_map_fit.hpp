#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::loop {

/// A time map with the highest harmonic that exceeds the tolerance when the loop is expanded under it.
struct TimeMapFit {
  TimeMap map;
  int harmonics = 0;
};

/// A fiftieth of the even density at least: below it the slow parts of the orbit would be resolved too coarsely.
inline constexpr double least_density = 0.02;

/// The highest k with sqrt(|a_k|^2 + |b_k|^2) > `tolerance`; 0 if there is none.
[[nodiscard]] int harmonics_above(const Loop& loop, double tolerance);

/// The map with its coefficients shrunk alike until the density is nowhere below `least` < 1. Throws MisuseError where
/// kappa is not 1.
[[nodiscard]] TimeMap with_least_density(TimeMap map, double least);

/// Up to `most` harmonics of density, from the distance of the loop's singularities in complex time as its derivatives
/// of order 4 to 7 show it: s advances in proportion to (|z^(q)| / q!)^(1/q). Invariant under `isotropy`, density >=
/// `least`.
[[nodiscard]] TimeMapFit fit_general(const Loop& loop, const Isotropy& isotropy, double tolerance, int most = 16,
                                     double least = least_density);

/// As fit_general, but it is the logarithm of the density that has up to `most` harmonics: the density may fall to any
/// part of the even one, and has as many harmonics as that takes. For orbits with time scales far apart.
[[nodiscard]] TimeMapFit fit_scales(const Loop& loop, const Isotropy& isotropy, double tolerance, int most = 32);

/// The map with this density in any unit, positive and given at nodes equidistant in s, with at most `most` harmonics:
/// those that count beside its least value.
[[nodiscard]] TimeMap map_of_density(std::vector<double> density, int most = std::numeric_limits<int>::max());

/// What of the map's coefficients is invariant under the symmetries.
[[nodiscard]] TimeMap invariant(TimeMap map, const Isotropy& isotropy);

/// How fast s is to run, ds/dt > 0 in any unit, at the samples of a loop.
using Rate = std::function<std::vector<double>(const Samples& samples)>;

/// The map under which s runs at that rate, with as many harmonics of density as it takes; a smooth rate of any range
/// will do. Invariant under `isotropy` as far as the rate is.
[[nodiscard]] TimeMapFit fit_to_rate(const Loop& loop, const Rate& rate, const Isotropy& isotropy, double tolerance);

/// True if the time map goes with the symmetries: they then act on the loop's harmonics as without a map.
[[nodiscard]] bool is_invariant(const TimeMap& map, const Isotropy& isotropy);

}  // namespace orbweaver::loop
