#include "resampled.hpp"

#include <cstddef>

#include "grid/scattered_sums.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

using numerics::two_pi;

std::vector<double> resampled(const Loop& loop, const TimeMap& target, int nodes, int first, int stride) {
  std::vector<double> at;
  for (int j = first; j < nodes; j += stride) at.push_back(two_pi * static_cast<double>(j) / nodes);
  const std::vector<double> s = loop.time_map.parameters_at(target, at);
  std::vector<double> out = scattered_sums(loop.cutoff, loop.dimension, loop.modes.data(), s);
  for (std::size_t i = 0; i < loop.winding.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j) out[i * s.size() + j] += loop.winding[i] * (s[j] - at[j]);
  return out;
}

}  // namespace orbweaver::loop
