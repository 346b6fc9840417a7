#include "resampled.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

// Nodes taken together: what they need stays in the first cache while all harmonics are added.
constexpr std::size_t block = 32;

// z - n s at any parameters s: dimension x s.size(), component-major. Harmonics are turned on by one multiplication a
// node.
std::vector<double> periodic_part_at(const Loop& loop, std::span<const double> s) {
  const std::size_t n = s.size();
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> out(d * n), values(d * block);
  double first_cosine[block] = {}, first_sine[block] = {}, cosine[block], sine[block];
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = std::min(block, n - first);
    for (std::size_t j = 0; j < count; ++j) {
      first_cosine[j] = std::cos(s[first + j]);
      first_sine[j] = std::sin(s[first + j]);
    }
    std::copy_n(first_cosine, block, cosine);
    std::copy_n(first_sine, block, sine);
    for (std::size_t i = 0; i < d; ++i) std::fill_n(values.data() + i * block, block, loop.modes[i]);
    for (int k = 1; k <= loop.cutoff; ++k) {
      for (int i = 0; i < loop.dimension; ++i) {
        const double a = loop.cosine(k, i);
        const double b = loop.sine(k, i);
        double* z = values.data() + static_cast<std::size_t>(i) * block;
        for (std::size_t j = 0; j < block; ++j) z[j] += a * cosine[j] + b * sine[j];
      }
      for (std::size_t j = 0; j < block; ++j) {
        const double next = cosine[j] * first_cosine[j] - sine[j] * first_sine[j];
        sine[j] = sine[j] * first_cosine[j] + cosine[j] * first_sine[j];
        cosine[j] = next;
      }
    }
    for (std::size_t i = 0; i < d; ++i) std::copy_n(values.data() + i * block, count, out.data() + i * n + first);
  }
  return out;
}

}  // namespace

std::vector<double> resampled(const Loop& loop, const TimeMap& target, int nodes, int first, int stride) {
  std::vector<double> at;
  for (int j = first; j < nodes; j += stride) at.push_back(two_pi * static_cast<double>(j) / nodes);
  const std::vector<double> s = loop.time_map.parameters_at(target, at);
  std::vector<double> out = periodic_part_at(loop, s);
  for (std::size_t i = 0; i < loop.winding.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j) out[i * s.size() + j] += loop.winding[i] * (s[j] - at[j]);
  return out;
}

}  // namespace orbweaver::loop
