#include "grid/scattered_sums.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "loop/samples.hpp"

namespace orbweaver::loop::scattered_sums_test {
namespace {

/// The largest error at some parameters, relative to the loop, against sums in long double.
double largest_error(int cutoff, std::size_t count, double decay) {
  const Loop loop = test::random_loop(3, cutoff, 31, 1.0, decay);
  std::vector<double> s = test::random_values(count, 32);
  for (double& each : s) each = (each - std::floor(each)) * test::two_pi;
  s[0] = 0.0;
  s[1] = test::two_pi;
  s[2] = -1e-300;
  s[3] = std::nextafter(test::two_pi, 0.0);
  const std::vector<double> found = scattered_sums(cutoff, 3, loop.modes.data(), s);
  double size = 0.0;
  for (const double v : loop.modes) size = std::max(size, std::abs(v));
  double error = 0.0;
  for (std::size_t j = 0; j < count; j = j < 3 ? j + 1 : j + count / 40)
    for (std::size_t i = 0; i < 3; ++i) {
      long double sum = loop.modes[i];
      for (int k = 1; k <= cutoff; ++k)
        sum += loop.cosine(k, static_cast<int>(i)) * std::cos(static_cast<long double>(s[j]) * k) +
               loop.sine(k, static_cast<int>(i)) * std::sin(static_cast<long double>(s[j]) * k);
      error = std::max(error, static_cast<double>(std::abs(found[i * count + j] - sum)));
    }
  return error / size;
}

TEST(ScatteredSums, AreTheSums) {
  EXPECT_LT(largest_error(20, 500, 0.8), 1e-14);    // one by one
  EXPECT_LT(largest_error(400, 100, 0.93), 1e-13);  // few
  EXPECT_LT(largest_error(96, 240, 0.8), 1e-14);    // by a transform
  EXPECT_LT(largest_error(400, 1602, 0.93), 1e-13);
  EXPECT_LT(largest_error(2000, 8002, 0.985), 3e-13);
}

TEST(ScatteredSums, HaveParametersOfAnyTurn) {
  const Loop loop = test::random_loop(3, 200, 33, 1.0, 0.9);
  std::vector<double> s(240, 1.0);
  s[1] += test::two_pi;
  s[2] -= 3.0 * test::two_pi;
  const std::vector<double> found = scattered_sums(200, 3, loop.modes.data(), s);
  for (const std::size_t j : {1, 2}) EXPECT_NEAR(found[j], found[0], 1e-12);
}

}  // namespace
}  // namespace orbweaver::loop::scattered_sums_test
