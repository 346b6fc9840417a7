#include "orbweaver/model/rounded.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "orbweaver/numerics/quad.hpp"

namespace orbweaver::model::rounded_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Terms of all sizes, some of which cancel.
template <class S>
S function(const S& x, const S& y) {
  using std::atan, std::cos, std::exp, std::log, std::sin, std::sqrt;
  const S sum = exp(x) - x - S(1.0) + (S(1.0) - cos(y)) / (x * x + S(3.0));
  return sum * sqrt(S(2.0) + sin(x * y)) - log(S(1.0) + x * S(0.5)) * atan(y) - (-x);
}

// The bound holds, and no error of a few hundred numbers is much below it.
TEST(Rounded, BoundsWhatRoundingLeaves) {
  double largest = 0.0;
  for (int n = 1; n < 300; ++n) {
    const double x = 1e-5 * n * n;
    const double y = 0.37 / n;
    const Rounded found = function(Rounded(x), Rounded(y));
    const auto exact = function(numerics::Quad(x), numerics::Quad(y));
    const double error = std::abs(static_cast<double>(numerics::Quad(found.value()) - exact));
    EXPECT_LE(error, found.error()) << n;
    largest = std::max(largest, error / found.error());
  }
  EXPECT_GT(largest, 0.1);
}

TEST(Rounded, OfTermsThatCancelIsTheirs) {
  const Rounded x(1e-7);
  EXPECT_EQ((exp(x) - x - Rounded(1.0)).value(), std::exp(1e-7) - 1e-7 - 1.0);
  EXPECT_GT((exp(x) - x - Rounded(1.0)).error(), epsilon);
  EXPECT_LT((exp(x) - x - Rounded(1.0)).error(), 3.0 * epsilon);
  EXPECT_LT((x * x).error(), 1.0 * epsilon * 1e-14);
  EXPECT_EQ(Rounded(3.0).error(), 0.0);
}

}  // namespace
}  // namespace orbweaver::model::rounded_test
