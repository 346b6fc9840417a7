#include "orbweaver/ad/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/dual.hpp"

namespace lanes_test {
namespace {

using orbweaver::ad::Dual;
using orbweaver::ad::Lanes;

constexpr std::size_t width = Lanes::width;
constexpr double pi = std::numbers::pi;
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Distance in units of the last place of `expected`.
double ulps(double value, long double expected) {
  const double rounded = static_cast<double>(expected);
  const double unit = std::nextafter(std::abs(rounded), inf) - std::abs(rounded);
  return static_cast<double>(std::abs(value - expected) / unit);
}

template <class Function>
double in_lane(const Function& function, double x, std::size_t lane, double elsewhere) {
  Lanes lanes(elsewhere);
  lanes.packed[lane] = x;
  return function(lanes).packed[lane];
}

Lanes sine(Lanes x) { return sin(x); }
Lanes cosine(Lanes x) { return cos(x); }

TEST(Lanes, SineAndCosineToOneUlp) {
  std::mt19937_64 generator(5);
  for (const double range : {1e-8, 0.5, 4.0, 40.0, 3e4, 1e6, 1e15}) {
    std::uniform_real_distribution<double> uniform(-range, range);
    for (int sample = 0; sample < 20000; ++sample) {
      const double x = uniform(generator);
      // In long double sin reduces with 66 bits of pi, too few far out; there std::sin(double) is right to half an ulp.
      const bool far = range > 1e3;
      const long double s = far ? std::sin(x) : std::sin(static_cast<long double>(x));
      const long double c = far ? std::cos(x) : std::cos(static_cast<long double>(x));
      ASSERT_LE(ulps(sin(Lanes(x)).packed[0], s), far ? 1.3 : 0.85) << x;
      ASSERT_LE(ulps(cos(Lanes(x)).packed[0], c), far ? 1.3 : 0.85) << x;
    }
  }
}

TEST(Lanes, SineAndCosineNextToTheirZeros) {
  for (int n = 1; n < 25000; ++n) {
    const double near = n * (pi / 2);
    for (const double x : {std::nextafter(near, 0.0), near, std::nextafter(near, inf)}) {
      ASSERT_LE(ulps(sin(Lanes(x)).packed[0], std::sin(x)), 1.6) << x;
      ASSERT_LE(ulps(cos(Lanes(-x)).packed[0], std::cos(x)), 1.6) << x;
    }
  }
}

TEST(Lanes, SpecialValuesStayInTheirLane) {
  for (const auto& function : {sine, cosine}) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      for (const double special : {nan, inf, -inf, 0.0, -0.0, 1e-310, 1e22, 32768.0, -1e300, 1.7e308}) {
        const double value = in_lane(function, special, lane, 0.75);
        const double expected = function == sine ? std::sin(special) : std::cos(special);
        if (std::isfinite(special))
          EXPECT_LE(std::abs(value - expected), 1.2e-16 * std::abs(expected)) << special;
        else
          EXPECT_TRUE(std::isnan(value)) << special;
        // Among these some differ from std::sin in the last bit, so that a change of way would show.
        for (double x = -3.0; x < 3.0; x += 0.037)
          ASSERT_EQ(in_lane(function, x, lane, special), in_lane(function, x, 0, x)) << x << " beside " << special;
      }
    }
  }
}

TEST(Lanes, SineIsOddAndCosineEvenToTheLastBit) {
  std::mt19937_64 generator(6);
  std::uniform_real_distribution<double> uniform(-50.0, 50.0);
  for (int sample = 0; sample < 1000; ++sample) {
    const Lanes x(uniform(generator));
    ASSERT_EQ(sin(-x).packed[0], -sin(x).packed[0]);
    ASSERT_EQ(cos(-x).packed[0], cos(x).packed[0]);
  }
}

TEST(Lanes, ArithmeticIsThatOfEachLane) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  double a[width];
  double b[width];
  for (std::size_t l = 0; l < width; ++l) {
    a[l] = uniform(generator);
    b[l] = uniform(generator);
  }
  const Lanes x = Lanes::load(a, width);
  const Lanes y = Lanes::load(b, width);
  for (std::size_t l = 0; l < width; ++l) {
    EXPECT_EQ((x + y).packed[l], a[l] + b[l]);
    EXPECT_EQ((x - y).packed[l], a[l] - b[l]);
    EXPECT_EQ((x * y).packed[l], a[l] * b[l]);
    EXPECT_EQ((x / y).packed[l], a[l] / b[l]);
    EXPECT_EQ((-x).packed[l], -a[l]);
    EXPECT_EQ((2.0 - x).packed[l], 2.0 - a[l]);
    EXPECT_EQ((x * 3.0).packed[l], a[l] * 3.0);
    EXPECT_EQ(sqrt(x).packed[l], std::sqrt(a[l]));
    EXPECT_EQ(exp(x).packed[l], std::exp(a[l]));
    EXPECT_EQ(log(x).packed[l], std::log(a[l]));
    EXPECT_EQ(tan(x).packed[l], std::tan(a[l]));
    EXPECT_EQ(asin(x).packed[l], std::asin(a[l]));
    EXPECT_EQ(acos(x).packed[l], std::acos(a[l]));
    EXPECT_EQ(atan(x).packed[l], std::atan(a[l]));
    EXPECT_EQ(sinh(x).packed[l], std::sinh(a[l]));
    EXPECT_EQ(cosh(x).packed[l], std::cosh(a[l]));
    EXPECT_EQ(tanh(x).packed[l], std::tanh(a[l]));
    EXPECT_EQ(pow(x, 1.7).packed[l], std::pow(a[l], 1.7));
  }
  EXPECT_TRUE(std::signbit(Lanes(-0.0).packed[0]));
}

TEST(Lanes, PartialGroupsRepeatTheLastAndWriteNoMore) {
  std::vector<double> from(width);
  for (std::size_t l = 0; l < width; ++l) from[l] = static_cast<double>(l) + 1.0;
  for (std::size_t count = 1; count <= width; ++count) {
    const Lanes lanes = Lanes::load(from.data(), count);
    std::vector<double> to(width, -1.0);
    lanes.store(to.data(), count);
    for (std::size_t l = 0; l < width; ++l) {
      EXPECT_EQ(lanes.packed[l], from[std::min(l, count - 1)]);
      EXPECT_EQ(to[l], l < count ? from[l] : -1.0);
    }
  }
  std::vector<double> unaligned(width + 1, -1.0);
  Lanes::load(from.data()).store(unaligned.data() + 1);
  for (std::size_t l = 0; l < width; ++l) EXPECT_EQ(unaligned[l + 1], from[l]);
}

// Slopes of all functions, at the second order too, by the complex step's real cousin: derivatives of the derivative
// are compared with differences of order four.
template <class Function>
void check_slopes(const Function& function, double x) {
  using First = Dual<double, 1>;
  using Second = Dual<First, 1>;
  constexpr double h = 1e-3;
  const auto value = [&](double at) { return function(First::variable(at, 0)).value; };
  const auto slope = [&](double at) { return function(First::variable(at, 0)).derivatives[0]; };
  const auto difference = [&](const auto& f) {
    return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12.0 * h);
  };
  const Second result = function(Second::variable(First::variable(x, 0), 0));
  EXPECT_EQ(result.value.value, value(x));
  EXPECT_NEAR(slope(x), difference(value), 3e-10 * (1.0 + std::abs(slope(x))));
  EXPECT_NEAR(result.value.derivatives[0], slope(x), 1e-14 * (1.0 + std::abs(slope(x))));
  EXPECT_NEAR(result.derivatives[0].derivatives[0], difference(slope), 3e-9);
  using InLanes = Dual<Lanes, 1>;
  const InLanes lanes = function(InLanes::variable(Lanes(x), 0));
  EXPECT_NEAR(lanes.value.packed[width - 1], value(x), 4e-16 * (1.0 + std::abs(value(x))));
  EXPECT_NEAR(lanes.derivatives[0].packed[width - 1], slope(x), 1e-15 * (1.0 + std::abs(slope(x))));
}

TEST(Dual, SlopesOfEveryFunction) {
  const double x = 0.6;
  check_slopes([](const auto& a) { return sqrt(a); }, x);
  check_slopes([](const auto& a) { return exp(a); }, x);
  check_slopes([](const auto& a) { return log(a); }, x);
  check_slopes([](const auto& a) { return sin(a); }, x);
  check_slopes([](const auto& a) { return cos(a); }, x);
  check_slopes([](const auto& a) { return tan(a); }, x);
  check_slopes([](const auto& a) { return asin(a); }, x);
  check_slopes([](const auto& a) { return acos(a); }, x);
  check_slopes([](const auto& a) { return atan(a); }, x);
  check_slopes([](const auto& a) { return sinh(a); }, x);
  check_slopes([](const auto& a) { return cosh(a); }, x);
  check_slopes([](const auto& a) { return tanh(a); }, x);
  check_slopes([](const auto& a) { return pow(a, 2.5); }, x);
  check_slopes([](const auto& a) { return 3.0 / a; }, x);
  check_slopes([](const auto& a) { return a / 3.0; }, x);
  check_slopes([](const auto& a) { return (2.0 - a) / (1.0 + a * a); }, x);
  check_slopes(
      [](const auto& a) {
        auto b = a;
        b *= a;
        b += 1.0;
        b /= a;
        b -= a;
        return b * 0.5 - 2.0;
      },
      x);
}

TEST(Dual, PowersAtZero) {
  const auto zero = Dual<double, 1>::variable(0.0, 0);
  EXPECT_EQ(pow(zero, 0.0).derivatives[0], 0.0);
  EXPECT_EQ(pow(zero, 1.0).derivatives[0], 1.0);
  EXPECT_EQ(pow(zero, 2.0).derivatives[0], 0.0);
}

}  // namespace
}  // namespace lanes_test
