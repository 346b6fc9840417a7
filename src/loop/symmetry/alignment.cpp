#include "orbweaver/loop/symmetry/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "symmetry/mapped_shift.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

/// Distances of loops that differ by less are equal but for rounding.
constexpr double equally_close = 1e-12;
/// Squares of distances come from differences of large numbers, of the size of the loop's square: minima that agree to
/// this are compared by the loops themselves.
constexpr double same_square = 1e-9;
/// Of the tolerance: a shift by T/prime changes a harmonic by at most twice its size, and samples add rounding.
constexpr double of_samples = 4.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Either way from 0, in periods.
double length_of(double shift) { return std::abs(shift - std::round(shift)); }

double in_period(double shift) {
  const double part = shift - std::floor(shift);
  return part < 1.0 ? part : 0.0;
}

// The closest shift under one candidate; of equally close ones the smallest.
Alignment closest(const SymmetryElement& candidate, const Loop& from, const Loop& to, const std::vector<int>& angles) {
  Alignment best{candidate.name, candidate.reversing, candidate.map, 0.0, {}, infinity};
  const Loop image = transformed(from, candidate.map, candidate.reversing, 0.0);
  if (image.winding != to.winding) return best;
  const std::vector<ShiftMinimum> minima = shift_minima(image, to, angles);
  const double within = minima.front().square + same_square * (1.0 + std::pow(rms_size(to), 2));
  for (const ShiftMinimum& minimum : minima) {
    if (minimum.square > within) break;
    // w(t) = y(t + psi) with y = M^-1 z(+-t): the shift of z counts backwards if reversing.
    const double shift = in_period(candidate.reversing ? -minimum.shift : minimum.shift);
    std::vector<double> turns;
    const double psi = candidate.reversing ? -shift : shift;
    const double distance = rms_size(difference_at(image, to, angles, psi, &turns));
    const double gain = best.distance - distance;
    if (gain > equally_close || (gain > -equally_close && length_of(shift) < length_of(best.shift))) {
      best.shift = shift;
      best.turns = turns;
      best.distance = distance;
    }
  }
  return best;
}

Alignment closest(const systems::Structure& system, const Loop& from, const Loop& to) {
  Alignment best;
  const SymmetryGroup group = SymmetryGroup::of_space(system);
  for (const SymmetryElement& candidate : group.elements()) {
    Alignment found = closest(candidate, from, to, system.angles);
    if (best.name.empty() || found.distance < best.distance - equally_close) best = std::move(found);
  }
  return best;
}

Loop coarse(const Loop& loop) { return loop.time_map.is_identity() ? loop : interpolant(time_samples(loop)); }

}  // namespace

Alignment align(const systems::Structure& system, const Loop& from, const Loop& to, double hopeless) {
  core::require(from.dimension == to.dimension && from.dimension == system.dimension,
                "loops of different dimension cannot be aligned");
  if (std::isfinite(hopeless)) {
    Alignment best = closest(system, coarse(from), coarse(to));
    if (best.distance > hopeless || (from.time_map.is_identity() && to.time_map.is_identity())) return best;
  }
  return closest(system, resolved_in_time(from), resolved_in_time(to));
}

Alignment align_in_time(const systems::Structure& system, const Loop& from, const Loop& to) {
  const bool are_even = from.time_map.is_identity() && to.time_map.is_identity();
  const Loop rough_from = coarse(from);
  const Loop rough_to = coarse(to);
  const double nearest = shift_minima(rough_from, rough_to, system.angles).front().shift;
  std::vector<double> shifts{nearest};
  if (!are_even)
    shifts = {mapped_shift_near(from, to, system.angles, 0.0), mapped_shift_near(from, to, system.angles, nearest)};
  Alignment best;
  for (const double shift : shifts) {
    Alignment found{"1", false, systems::AffineMap::identity(system.dimension), in_period(shift), {}, infinity};
    (void)difference_at(rough_from, rough_to, system.angles, found.shift, &found.turns);
    found.distance = mean_distance(aligned(from, found), to);
    if (found.distance < best.distance) best = std::move(found);
  }
  return best;
}

Loop aligned(const Loop& from, const Alignment& alignment) {
  Loop out = transformed(from, alignment.map, alignment.reversing, alignment.shift);
  for (std::size_t i = 0; i < alignment.turns.size(); ++i)
    out.cosine(0, static_cast<int>(i)) += two_pi * alignment.turns[i];
  return out;
}

namespace {

// The loop, which goes m times around another one, with s run alike each time.
Loop with_equal_turns(const Loop& loop, int m) {
  if (loop.time_map.kappa != 1.0) return resolved_in_time(loop);
  const SymmetryElement turn{"1", false, systems::AffineMap::identity(loop.dimension), 1, m};
  return with_time_map(loop, invariant(loop.time_map, {turn}), loop.cutoff);
}

bool winds_by_multiples_of(const Loop& loop, int m) {
  return std::all_of(loop.winding.begin(), loop.winding.end(), [m](double n) { return std::fmod(n, m) == 0.0; });
}

// False only where no harmonic but multiples of `prime` can be below `tolerance`: by samples, whatever the time map. A
// shift by T/prime changes a harmonic by at most twice its size.
bool may_repeat(const Loop& loop, int prime, double tolerance) {
  const int step = (time_sample_count + prime - 1) / prime;
  const TimeSamples samples = time_samples(loop, step * prime);
  double sum = 0.0;
  for (int i = 0; i < samples.dimension; ++i)
    for (int j = 0; j < samples.count; ++j) {
      const double* z = samples.states.data() + static_cast<std::ptrdiff_t>(i) * samples.count;
      const double change = z[(j + step) % samples.count] - z[j];
      sum += change * change;
    }
  return std::sqrt(sum / samples.count) <= of_samples * tolerance;
}

}  // namespace

int repetitions(const Loop& loop, double tolerance) {
  const auto may = [&](int prime) { return may_repeat(loop, prime, tolerance); };
  if (!loop.time_map.is_identity() && !may(2) && !may(3) && !may(5) && !may(7) && !may(11)) return 1;
  const Loop even = resolved_in_time(loop);
  for (int m = 12; m > 1; --m) {
    double sum = 0.0;
    for (int k = 1; k <= even.cutoff; ++k)
      for (int i = 0; i < even.dimension && k % m != 0; ++i)
        sum += 0.5 * (even.cosine(k, i) * even.cosine(k, i) + even.sine(k, i) * even.sine(k, i));
    if (std::sqrt(sum) <= tolerance && winds_by_multiples_of(even, m)) return m;
  }
  return 1;
}

Loop without_repetition(const Loop& loop, int m) {
  core::require(m >= 1 && winds_by_multiples_of(loop, m), "a loop goes a whole number of times around a shorter one");
  if (m == 1) return loop;
  const Loop even = with_equal_turns(loop, m);
  Loop out = with_cutoff(even, std::max(1, even.cutoff / m));
  out.period = even.period / m;
  for (double& n : out.winding) n /= m;
  for (int k = 1; k <= out.cutoff; ++k)
    for (int i = 0; i < out.dimension; ++i) {
      out.cosine(k, i) = k * m <= even.cutoff ? even.cosine(k * m, i) : 0.0;
      out.sine(k, i) = k * m <= even.cutoff ? even.sine(k * m, i) : 0.0;
    }
  const std::vector<double>& map = even.time_map.coefficients;
  out.time_map.coefficients.clear();
  for (std::size_t k = static_cast<std::size_t>(m); 2 * k <= map.size(); k += static_cast<std::size_t>(m))
    out.time_map.coefficients.insert(out.time_map.coefficients.end(), {map[2 * k - 2], map[2 * k - 1]});
  return out;
}

}  // namespace orbweaver::loop
