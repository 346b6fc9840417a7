#pragma once

#include <cstdint>
#include <random>

namespace orbweaver::numerics {

/// Repeatable numbers in [-1, 1): the same for a seed on all platforms, which std::uniform_real_distribution does not
/// promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : _generator(seed) {}
  double operator()() { return static_cast<double>(_generator() >> 11) * 0x1p-52 - 1.0; }

 private:
  std::mt19937_64 _generator;
};

}  // namespace orbweaver::numerics
