#include "orbweaver/loop/symmetry/standard_phase.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

/// Coordinates of two instants that are nearer, relative to 1 + the loop's size, are the same: the next one decides.
constexpr double same_coordinate = 1e-9;
constexpr double settled_instant = 1e-15;  // a step in s that no longer changes it
constexpr int most_instant_steps =
    30;  // of Newton's method from a grid finer than the harmonics: three or four are needed

// The state at a point of a reversor's fixed set, angles that wind within [-pi/2, 3 pi/2): on such a set they are 0 or
// pi.
std::vector<double> state_to_compare(const Loop& loop, double shift) {
  std::vector<double> z = state_at(loop, shift * loop.period);
  for (std::size_t i = 0; i < z.size(); ++i)
    if (loop.winding[i] != 0.0) z[i] -= two_pi * std::floor(z[i] / two_pi + 0.25);
  return z;
}

// True if `a` comes after `b` in the order of the first coordinate that differs.
bool is_larger(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > tolerance) return a[i] > b[i];
  return false;
}

// s / 2 pi where the periodic part of coordinate i is largest.
double turns_of_maximum(const Loop& even, int i) {
  const int nodes = FourierGrid::nodes_at_least(4 * even.cutoff + 2);
  std::vector<double> modes(2 * static_cast<std::size_t>(even.cutoff) + 1, 0.0);
  for (int k = 1; k <= even.cutoff; ++k) {
    modes[2 * static_cast<std::size_t>(k) - 1] = even.cosine(k, i);
    modes[2 * static_cast<std::size_t>(k)] = even.sine(k, i);
  }
  std::vector<double> values(static_cast<std::size_t>(nodes));
  FourierGrid::of_size(nodes).synthesize(even.cutoff, 1, modes.data(), values.data());
  const auto highest = std::max_element(values.begin(), values.end()) - values.begin();
  const double spacing = two_pi / nodes;
  const double start = spacing * static_cast<double>(highest);
  double s = start;
  for (int n = 0; n < most_instant_steps; ++n) {  // Newton's method on dz/ds, within the neighbouring nodes
    double slope = 0.0;
    double curvature = 0.0;
    for (int k = even.cutoff; k >= 1; --k) {
      const double c = std::cos(k * s);
      const double sine = std::sin(k * s);
      slope += k * (even.sine(k, i) * c - even.cosine(k, i) * sine);
      curvature -= k * k * (even.cosine(k, i) * c + even.sine(k, i) * sine);
    }
    if (curvature == 0.0) break;
    const double next = std::clamp(s + slope / std::abs(curvature), start - spacing, start + spacing);
    const double step = std::abs(next - s);
    s = next;
    if (step < settled_instant) break;
  }
  return s / two_pi;
}

}  // namespace

Loop in_standard_phase(const systems::Structure& system, const Loop& loop, const Isotropy& isotropy) {
  const SymmetryGroup group(system, isotropy);
  for (const systems::Symmetry& reversor : system.reversors)
    for (const SymmetryElement& element : group.elements()) {
      if (!element.reversing || element.name != reversor.name) continue;
      const double first = 0.5 * element.shift();
      const double second = first + 0.5;
      const double tolerance = same_coordinate * (1.0 + rms_size(loop));
      const bool take_second = is_larger(state_to_compare(loop, second), state_to_compare(loop, first), tolerance);
      return time_shifted(loop, take_second ? second : first);
    }
  const int coordinate = system.angles.empty() ? 0 : system.angles.front();
  // A maximum over s is one over time, but for the linear part of an angle that winds.
  if (loop.winding[static_cast<std::size_t>(coordinate)] == 0.0)
    return parameter_shifted(loop, turns_of_maximum(loop, coordinate));
  return time_shifted(loop, turns_of_maximum(resolved_in_time(loop), coordinate));
}

Loop at_first_reversor(const systems::Structure& system, const Loop& loop, double tolerance) {
  for (const systems::Symmetry& reversor : system.reversors) {
    const Loop image = transformed(loop, reversor.map, true, 0.0);
    const std::vector<ShiftMinimum> minima = shift_minima(image, loop, system.angles);
    if (!minima.empty() && minima.front().square < tolerance * tolerance)
      return time_shifted(loop, -0.5 * minima.front().shift);
  }
  return loop;
}

}  // namespace orbweaver::loop
