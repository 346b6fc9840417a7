#include "orbweaver/loop/grid/time_map_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

/// Below the squares of all derivatives: keeps logarithms finite.
constexpr double tiny_square = 1e-300;
/// Coefficients of a density of mean 1 that differ by less are rounding.
constexpr double same_coefficient = 1e-14;
/// Orders of the derivatives that show the distance of the singularities: lower ones see the orbit's size, higher ones
/// noise.
constexpr int first_order = 4;
constexpr int last_order = 7;

/// Of a map's least density: what the harmonics that it leaves out may add up to, so that it stays positive and its
/// fast parts lie where the orbit is fast.
constexpr double negligible_density = 1e-4;
/// Nodes of a density that is fitted, at least: sharp ones have 20 to 80 harmonics.
constexpr int least_fit_nodes = 512;

/// Of fit_scales: nodes of a density for each harmonic of its logarithm, which falls by many orders between two;
/// passes, each of which sees what the one before has drawn apart; and how far above the tolerance harmonics are
/// counted.
constexpr int nodes_a_harmonic = 32;
constexpr int scale_passes = 3;
constexpr double above_truncation = 100.0;

// Candidates that would need more harmonics than the loop has are no gain: they count as that many.
TimeMapFit under(const Loop& loop, const TimeMap& map, double tolerance) {
  return {map, harmonics_above(with_time_map(loop, map, loop.cutoff), tolerance)};
}

Loop without_tail(const Loop& loop, double tolerance) {
  return with_cutoff(loop, std::min(loop.cutoff, harmonics_above(loop, tolerance) + 8));
}

// log(|d^q z/ds^q| / q!) / q at nodes, with k measured in cutoffs so that no power overflows.
std::vector<double> log_derivative(const Loop& loop, int order, int nodes) {
  Loop derivative = loop;
  for (int i = 0; i < loop.dimension; ++i) derivative.cosine(0, i) = 0.0;
  for (int k = 1; k <= loop.cutoff; ++k) {
    const double factor = std::pow(static_cast<double>(k) / loop.cutoff, order);
    for (int i = 0; i < loop.dimension; ++i) {
      double a = loop.cosine(k, i);
      double b = loop.sine(k, i);
      for (int turn = 0; turn < order % 4; ++turn) {
        std::swap(a, b);
        b = -b;
      }
      derivative.cosine(k, i) = factor * a;
      derivative.sine(k, i) = factor * b;
    }
  }
  const auto n = static_cast<std::size_t>(nodes);
  std::vector<double> nodal(static_cast<std::size_t>(loop.dimension) * n);
  FourierGrid::of_size(nodes).synthesize(loop.cutoff, loop.dimension, derivative.modes.data(), nodal.data());
  std::vector<double> out(n, tiny_square);
  for (std::size_t m = 0; m < nodal.size(); ++m) out[m % n] += nodal[m] * nodal[m];
  for (double& v : out) v = (0.5 * std::log(v) + order * std::log(loop.cutoff) - std::lgamma(order + 1.0)) / order;
  return out;
}

// The inverse distance of the nearest singularity in the plane of s, at nodes, scaled to mean 1.
std::vector<double> inverse_distance(const Loop& loop, int nodes) {
  std::vector<double> monitor(static_cast<std::size_t>(nodes), 0.0);
  for (int q = first_order; q <= last_order; ++q) {
    const std::vector<double> of_order = log_derivative(loop, q, nodes);
    for (std::size_t j = 0; j < monitor.size(); ++j) monitor[j] += of_order[j] / (last_order - first_order + 1);
  }
  double mean = 0.0;
  for (double& v : monitor) mean += v = std::exp(v);
  for (double& v : monitor) v *= nodes / mean;
  return monitor;
}

// s + integral of (rate - 1) ds from 0, at nodes, for a rate with mean 1.
std::vector<double> integrated(const std::vector<double>& rate) {
  const auto nodes = static_cast<int>(rate.size());
  const int highest = (nodes - 1) / 2;
  std::vector<double> modes(2 * static_cast<std::size_t>(highest) + 1);
  FourierGrid::of_size(nodes).analyze(highest, 1, rate.data(), modes.data());
  modes[0] = 0.0;
  for (std::size_t k = 1; 2 * k < modes.size(); ++k) {
    const double a = modes[2 * k - 1];
    modes[2 * k - 1] = -modes[2 * k] / static_cast<double>(k);
    modes[2 * k] = a / static_cast<double>(k);
  }
  std::vector<double> out(rate.size());
  FourierGrid::of_size(nodes).synthesize(highest, 1, modes.data(), out.data());
  const double start = out.front();
  for (std::size_t j = 0; j < out.size(); ++j) out[j] += two_pi * static_cast<double>(j) / nodes - start;
  return out;
}

// What of c cos ks + d sin ks is invariant under one symmetry.
void make_invariant(const SymmetryElement& g, int k, double& c, double& d) {
  const int turns = k * g.shift_numerator % g.shift_denominator;
  if (!g.reversing) {
    if (turns != 0) c = d = 0.0;
    return;
  }
  const double angle = two_pi * turns / g.shift_denominator;
  const double reflected_c = c * std::cos(angle) + d * std::sin(angle);
  const double reflected_d = c * std::sin(angle) - d * std::cos(angle);
  c = 0.5 * (c + reflected_c);
  d = 0.5 * (d + reflected_d);
}

}  // namespace

int harmonics_above(const Loop& loop, double tolerance) {
  for (int k = loop.cutoff; k >= 1; --k) {
    double sum = 0.0;
    for (int i = 0; i < loop.dimension; ++i)
      sum += loop.cosine(k, i) * loop.cosine(k, i) + loop.sine(k, i) * loop.sine(k, i);
    if (std::sqrt(sum) > tolerance) return k;
  }
  return 0;
}

TimeMap with_least_density(TimeMap map, double least) {
  core::require(map.kappa == 1.0 && least < 1.0, "only the coefficients of a time map can be shrunk");
  if (map.coefficients.empty()) return map;
  const std::vector<double> density = densities(map, 64 * static_cast<int>(map.coefficients.size()));
  const double lowest = *std::min_element(density.begin(), density.end());
  if (lowest < least)
    for (double& c : map.coefficients) c *= (1.0 - least) / (1.0 - lowest);
  return map;
}

TimeMapFit fit_general(const Loop& loop, const Isotropy& isotropy, double tolerance, int most, double least) {
  core::require(most >= 1, "a general time map needs at least one harmonic");
  const Loop shorter = without_tail(loop, tolerance);
  if (harmonics_above(shorter, tolerance) == 0) return {};
  const int nodes = FourierGrid::nodes_at_least(2 * nodes_for(shorter));
  const std::vector<double> s = integrated(inverse_distance(shorter, nodes));
  const std::vector<double> weights = densities(loop.time_map, nodes);
  TimeMap map;
  for (int k = 1; k <= most; ++k) {
    double c = 0.0;
    double d = 0.0;
    for (std::size_t j = 0; j < s.size(); ++j) {
      c += weights[j] * std::cos(k * s[j]);
      d += weights[j] * std::sin(k * s[j]);
    }
    for (const SymmetryElement& g : isotropy) make_invariant(g, k, c, d);
    const double x = std::numbers::pi * k / (most + 1);
    const double low_pass = 2.0 / nodes * std::sin(x) / x;
    map.coefficients.push_back(low_pass * c);
    map.coefficients.push_back(low_pass * d);
  }
  return under(shorter, with_least_density(map, least), tolerance);
}

namespace {

// The map with this density, of mean 1 and given at nodes.
TimeMap with_density(const std::vector<double>& density, int harmonics) {
  std::vector<double> modes(2 * static_cast<std::size_t>(harmonics) + 1);
  FourierGrid::of_size(static_cast<int>(density.size())).analyze(harmonics, 1, density.data(), modes.data());
  return {1.0, {modes.begin() + 1, modes.end()}};
}

// The harmonics of a map after which the others together are below a part of its least density.
std::size_t harmonics_that_count(const TimeMap& map, double least) {
  std::size_t count = map.coefficients.size() / 2;
  for (double rest = 0.0; count > 0; --count) {
    rest += std::hypot(map.coefficients[2 * count - 2], map.coefficients[2 * count - 1]);
    if (rest > negligible_density * least) break;
  }
  return count;
}

// With those only.
TimeMap with_what_counts(const std::vector<double>& density, int most) {
  TimeMap map = with_density(density, most);
  map.coefficients.resize(2 * harmonics_that_count(map, *std::min_element(density.begin(), density.end())));
  return map;
}

}  // namespace

TimeMap map_of_density(std::vector<double> density, int most) {
  const auto nodes = static_cast<int>(density.size());
  double sum = 0.0;
  for (const double v : density) sum += v;
  for (double& v : density) v *= nodes / sum;
  return with_what_counts(density, std::min(most, (nodes - 1) / 2));
}

TimeMap invariant(TimeMap map, const Isotropy& isotropy) {
  for (std::size_t n = 0; 2 * n < map.coefficients.size(); ++n)
    for (const SymmetryElement& g : isotropy)
      make_invariant(g, static_cast<int>(n + 1), map.coefficients[2 * n], map.coefficients[2 * n + 1]);
  return map;
}

namespace {

// The same density begun at another s, so that `fastest` lies at the phase at which it was: what runs fast there would
// be missed where slow parts, smoothed, take a little more or less time.
TimeMap aligned(TimeMap map, double fastest, double phase) {
  const double shift = -map.inverse(map.phase(fastest) - phase);
  for (std::size_t n = 0; 2 * n < map.coefficients.size(); ++n) {
    double& c = map.coefficients[2 * n];
    double& d = map.coefficients[2 * n + 1];
    const double cosine = std::cos(static_cast<double>(n + 1) * shift);
    const double sine = std::sin(static_cast<double>(n + 1) * shift);
    const double before = c;
    c = before * cosine - d * sine;
    d = before * sine + d * cosine;
  }
  return map;
}

// One pass of fit_scales: the map from what the loop shows under its own.
TimeMap scales_of(const Loop& loop, const Isotropy& isotropy, int most) {
  const int nodes = FourierGrid::nodes_at_least(2 * nodes_for(loop));
  const std::vector<double> rate = inverse_distance(loop, nodes);
  const std::vector<double> s = integrated(rate);
  std::vector<double> log_density = densities(loop.time_map, nodes);
  for (std::size_t j = 0; j < s.size(); ++j) log_density[j] = std::log(log_density[j] / rate[j]);
  std::vector<double> modes(2 * static_cast<std::size_t>(most) + 1, 0.0);  // of the logarithm, in the new s
  for (int k = 1; k <= most; ++k) {
    double c = 0.0;
    double d = 0.0;
    for (std::size_t j = 0; j < s.size(); ++j) {
      c += rate[j] * log_density[j] * std::cos(k * s[j]);
      d += rate[j] * log_density[j] * std::sin(k * s[j]);
    }
    for (const SymmetryElement& g : isotropy) make_invariant(g, k, c, d);
    const double x = std::numbers::pi * k / (most + 1);
    const double low_pass = 2.0 / nodes * std::sin(x) / x;
    modes[2 * static_cast<std::size_t>(k) - 1] = low_pass * c;
    modes[2 * static_cast<std::size_t>(k)] = low_pass * d;
  }
  const int fine = FourierGrid::nodes_at_least(std::max(least_fit_nodes, nodes_a_harmonic * most));
  std::vector<double> density(static_cast<std::size_t>(fine));
  FourierGrid::of_size(fine).synthesize(most, 1, modes.data(), density.data());
  for (double& v : density) v = std::exp(v);
  TimeMap map = map_of_density(std::move(density));
  const auto fastest =
      static_cast<std::size_t>(std::min_element(log_density.begin(), log_density.end()) - log_density.begin());
  // Reversors fix where s begins.
  if (std::none_of(isotropy.begin(), isotropy.end(), [](const SymmetryElement& g) { return g.reversing; }))
    map = aligned(std::move(map), s[fastest], loop.time_map.phase(two_pi * static_cast<double>(fastest) / nodes));
  return invariant(std::move(map), isotropy);
}

}  // namespace

TimeMapFit fit_scales(const Loop& loop, const Isotropy& isotropy, double tolerance, int most) {
  // What a loop leaves out is, where s runs faster than before, more than harmonics of the new map leave out.
  const double seen = above_truncation * tolerance;
  double size = 0.0;
  for (int k = 1; k <= loop.cutoff; ++k)
    for (int i = 0; i < loop.dimension; ++i) size = std::max(size, std::hypot(loop.cosine(k, i), loop.sine(k, i)));
  Loop at = without_tail(loop, seen);
  if (harmonics_above(at, seen) == 0) return {};
  TimeMapFit best;
  for (int pass = 0; pass < scale_passes; ++pass) {
    const TimeMap map = scales_of(at, isotropy, most);
    at = with_time_map(at, map, at.cutoff);
    const int above = harmonics_above(at, seen);
    // Harmonics fall like those of a function with singularities at one distance throughout.
    const int harmonics = static_cast<int>(std::ceil(above * std::log(size / tolerance) / std::log(size / seen)));
    if (pass == 0 || harmonics < best.harmonics) best = {map, harmonics};
    at = without_tail(at, seen);
  }
  return best;
}

TimeMapFit fit_to_rate(const Loop& loop, const Rate& rate, const Isotropy& isotropy, double tolerance) {
  const Loop shorter = without_tail(loop, tolerance);
  if (harmonics_above(shorter, tolerance) == 0) return {};
  const Samples samples = samples_of(shorter);
  std::vector<double> own = rate(samples);  // d(new s)/d(own s), of mean 1
  double mean = 0.0;
  for (std::size_t j = 0; j < own.size(); ++j) mean += own[j] *= samples.weights[j];
  for (double& v : own) v /= mean / samples.nodes;
  const TimeMap to_new = with_density(own, (samples.nodes - 1) / 2);
  const int fine = FourierGrid::nodes_at_least(std::max(least_fit_nodes, FourierGrid::nodes_for(shorter.cutoff)));
  std::vector<double> density(static_cast<std::size_t>(fine));
  for (int j = 0; j < fine; ++j) {
    const double before = to_new.inverse(two_pi * j / fine);
    density[static_cast<std::size_t>(j)] = shorter.time_map.density(before) / to_new.density(before);
  }
  return under(shorter, invariant(with_what_counts(density, (fine - 1) / 2), isotropy), tolerance);
}

bool is_invariant(const TimeMap& map, const Isotropy& isotropy) {
  return std::all_of(isotropy.begin(), isotropy.end(), [&](const SymmetryElement& g) {
    if (!g.reversing) return map.is_invariant_under_shift(g.shift());
    if (map.kappa != 1.0 && 2 * g.shift_numerator % g.shift_denominator != 0) return false;
    for (std::size_t n = 0; 2 * n + 1 < map.coefficients.size(); ++n) {
      double c = map.coefficients[2 * n];
      double d = map.coefficients[2 * n + 1];
      make_invariant(g, static_cast<int>(n + 1), c, d);
      if (std::abs(c - map.coefficients[2 * n]) + std::abs(d - map.coefficients[2 * n + 1]) > same_coefficient)
        return false;
    }
    return true;
  });
}

}  // namespace orbweaver::loop
