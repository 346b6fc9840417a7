#include "resampled.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace orbweaver::loop {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

// z - n s at any parameters s: dimension x s.size(), component-major. Harmonics are turned on by one multiplication a
// node.
std::vector<double> periodic_part_at(const Loop& loop, std::span<const double> s) {
  const std::size_t n = s.size();
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> first_cosine(n), first_sine(n), cosine(n), sine(n), out(d * n);
  for (std::size_t j = 0; j < n; ++j) {
    cosine[j] = first_cosine[j] = std::cos(s[j]);
    sine[j] = first_sine[j] = std::sin(s[j]);
  }
  for (std::size_t i = 0; i < d; ++i) std::fill_n(out.data() + i * n, n, loop.modes[i]);
  for (int k = 1; k <= loop.cutoff; ++k) {
    for (int i = 0; i < loop.dimension; ++i) {
      const double a = loop.cosine(k, i);
      const double b = loop.sine(k, i);
      double* z = out.data() + static_cast<std::size_t>(i) * n;
      for (std::size_t j = 0; j < n; ++j) z[j] += a * cosine[j] + b * sine[j];
    }
    for (std::size_t j = 0; j < n; ++j) {
      const double next = cosine[j] * first_cosine[j] - sine[j] * first_sine[j];
      sine[j] = sine[j] * first_cosine[j] + cosine[j] * first_sine[j];
      cosine[j] = next;
    }
  }
  return out;
}

}  // namespace

std::vector<double> resampled(const Loop& loop, const TimeMap& target, int nodes, int first, int stride) {
  std::vector<double> at;
  std::vector<double> s;
  for (int j = first; j < nodes; j += stride) {
    at.push_back(two_pi * static_cast<double>(j) / nodes);
    s.push_back(loop.time_map.parameter_at(target, at.back()));
  }
  std::vector<double> out = periodic_part_at(loop, s);
  for (std::size_t i = 0; i < loop.winding.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j) out[i * s.size() + j] += loop.winding[i] * (s[j] - at[j]);
  return out;
}

}  // namespace orbweaver::loop
