#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "orbweaver/numerics/random.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

/// Repeatable numbers in [-1, 1).
inline std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
  numerics::Random random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = random();
  return values;
}

/// A loop with random modes, harmonic k scaled by decay^k; not an orbit of anything.
inline loop::Loop random_loop(int dimension, int cutoff, std::uint64_t seed, double period = 4.2, double decay = 0.7) {
  loop::Loop loop = loop::constant_loop(random_values(static_cast<std::size_t>(dimension), seed), period, cutoff);
  const std::vector<double> values = random_values(loop.modes.size(), seed + 1000);
  std::size_t next = 0;
  for (int k = 1; k <= cutoff; ++k)
    for (int i = 0; i < dimension; ++i) {
      loop.cosine(k, i) = std::pow(decay, k) * values[next++];
      loop.sine(k, i) = std::pow(decay, k) * values[next++];
    }
  return loop;
}

/// `base` plus a random perturbation within a subspace, harmonic k scaled by decay^k.
inline loop::Loop random_loop_in(const loop::Subspace& subspace, const loop::Loop& base, std::uint64_t seed,
                                 double decay = 0.7) {
  loop::Loop loop = base;
  std::vector<double> coordinates = random_values(static_cast<std::size_t>(subspace.size()), seed);
  for (int n = 0; n < subspace.size(); ++n)
    coordinates[static_cast<std::size_t>(n)] *= std::pow(decay, subspace.harmonic(n));
  subspace.add_to(coordinates, loop.modes);
  return loop;
}

/// The declared symmetry `name` of a system with a time shift.
inline loop::SymmetryElement element_of(const systems::Structure& system, const std::string& name, int numerator = 0,
                                        int denominator = 1) {
  for (const systems::Symmetry& s : system.equivariances)
    if (s.name == name) return {name, false, s.map, numerator, denominator};
  for (const systems::Symmetry& r : system.reversors)
    if (r.name == name) return {name, true, r.map, numerator, denominator};
  throw std::invalid_argument("no symmetry " + name);
}

/// z and dz/ds at phase s by the definition: sums over modes, in long double.
struct Direct {
  std::vector<double> state;
  std::vector<double> slope;
};

inline Direct direct_sum(const loop::Loop& loop, double s) {
  const auto d = static_cast<std::size_t>(loop.dimension);
  Direct out{std::vector<double>(d), std::vector<double>(d)};
  for (std::size_t i = 0; i < d; ++i) {
    const long double phase = s;
    long double z = loop.winding[i] * phase + loop.modes[i];
    long double dz = loop.winding[i];
    for (std::size_t k = 1; k <= static_cast<std::size_t>(loop.cutoff); ++k) {
      const long double a = loop.modes[(2 * k - 1) * d + i];
      const long double b = loop.modes[2 * k * d + i];
      const auto kk = static_cast<long double>(k);
      z += a * std::cos(kk * phase) + b * std::sin(kk * phase);
      dz += kk * (b * std::cos(kk * phase) - a * std::sin(kk * phase));
    }
    out.state[i] = static_cast<double>(z);
    out.slope[i] = static_cast<double>(dz);
  }
  return out;
}

inline double squared(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum;
}

inline double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum);
}

}  // namespace orbweaver::test
