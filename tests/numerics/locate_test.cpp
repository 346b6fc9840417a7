#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace locate_test {
namespace {

using namespace orbweaver;
using numerics::locate_minimum;
using numerics::locate_root;

TEST(LocateRoot, FindsARootToItsTolerance) {
  for (const double tolerance : {1e-3, 1e-8, 1e-13}) {
    const auto root = locate_root([](double x) { return std::cos(x); }, 1.0, 3.0, tolerance);
    ASSERT_TRUE(root);
    EXPECT_TRUE(root->converged);
    EXPECT_LE(root->width, tolerance);
    EXPECT_LE(std::abs(root->position - 0.5 * std::numbers::pi), tolerance);
    EXPECT_EQ(root->value, std::cos(root->position));
    EXPECT_LE(root->evaluations, 14);
  }
}

TEST(LocateRoot, TakesFewEvaluations) {
  const auto root = locate_root([](double x) { return std::tanh(3 * (x - 0.37)); }, 0.0, 1.0, 1e-10);
  ASSERT_TRUE(root);
  EXPECT_NEAR(root->position, 0.37, 1e-10);
  EXPECT_LE(root->evaluations, 12);
}

TEST(LocateRoot, SaysWhenItRanOutOfEvaluations) {
  int calls = 0;
  const auto root = locate_root(
      [&](double x) {
        ++calls;
        return x < 0.123 ? -1.0 : 1.0;
      },
      0.0, 1.0, 1e-12, 12);
  ASSERT_TRUE(root);
  EXPECT_FALSE(root->converged);
  EXPECT_GT(root->width, 1e-12);
  EXPECT_LE(calls, 12);
  EXPECT_EQ(root->evaluations, calls);
}

TEST(LocateRoot, EndsCount) {
  const auto line = [](double x) { return x - 1.0; };
  EXPECT_EQ(locate_root(line, 1.0, 2.0, 1e-9)->position, 1.0);
  EXPECT_EQ(locate_root(line, 0.0, 1.0, 1e-9)->position, 1.0);
  const auto falling = locate_root([](double x) { return 1.0 - x; }, 0.0, 1.0, 1e-9);
  ASSERT_TRUE(falling);
  EXPECT_EQ(falling->position, 1.0);
}

TEST(LocateRoot, GivesTheSmallestValueThatItSaw) {
  for (const int evaluations : {6, 7, 8, 9, 10}) {
    const auto root = locate_root([](double x) { return x < 0.123 ? -0.5 : 1.0; }, 0.0, 1.0, 1e-12, evaluations);
    ASSERT_TRUE(root);
    EXPECT_EQ(root->value, -0.5);
    EXPECT_LT(root->position, 0.123);
  }
}

TEST(LocateRoot, SaysWhereThereIsNone) {
  int calls = 0;
  const auto counted = [&](double x) {
    ++calls;
    return x - 0.5;
  };
  EXPECT_FALSE(locate_root(counted, {0.0, std::nan("")}, {1.0, 0.5}, 1e-9));
  EXPECT_FALSE(locate_root(counted, {0.0, -0.5}, {1.0, std::nan("")}, 1e-9));
  EXPECT_EQ(calls, 0);

  EXPECT_FALSE(locate_root([](double x) { return 1.0 + x * x; }, -1.0, 2.0, 1e-9));
  EXPECT_FALSE(locate_root([](double x) { return x > 0.4 && x < 0.7 ? std::nan("") : x - 0.5; }, 0.0, 1.0, 1e-9));
  EXPECT_THROW((void)locate_root([](double x) { return x; }, 1.0, -1.0, 1e-9), core::MisuseError);
  EXPECT_THROW((void)locate_root([](double x) { return x; }, -1.0, 1.0, 0.0), core::MisuseError);
}

TEST(LocateMinimum, FindsAMinimum) {
  const auto least = locate_minimum([](double x) { return (x - 20.3) * (x - 20.3) + 0.25; }, 20.0, 21.0, 1e-6);
  ASSERT_TRUE(least);
  EXPECT_TRUE(least->converged);
  EXPECT_NEAR(least->position, 20.3, 1e-6);
  EXPECT_NEAR(least->value, 0.25, 1e-12);
  EXPECT_LE(least->evaluations, 12);
}

TEST(LocateMinimum, SaysHowFarItCame) {
  const auto parabola = [](double x) { return (x - 300.0) * (x - 300.0); };
  const auto least = locate_minimum(parabola, 0.0, 1000.0, 1e-3);
  ASSERT_TRUE(least);
  EXPECT_TRUE(least->converged);
  EXPECT_NEAR(least->width, 1e-3, 1e-15);
  const auto early = locate_minimum([](double x) { return std::cosh(0.01 * (x - 300.0)); }, 0.0, 1000.0, 1e-3, 4);
  ASSERT_TRUE(early);
  EXPECT_FALSE(early->converged);
}

TEST(LocateMinimum, FindsTheKinkOfAModulus) {
  const auto least = locate_minimum([](double x) { return std::abs(std::sin(x)); }, 2.0, 4.0, 1e-7);
  ASSERT_TRUE(least);
  EXPECT_NEAR(least->position, std::numbers::pi, 1e-7);
}

TEST(LocateMinimum, SaysWhereThereIsNone) {
  EXPECT_FALSE(locate_minimum([](double) { return std::nan(""); }, 0.0, 1.0, 1e-6));
  EXPECT_THROW((void)locate_minimum([](double x) { return x; }, 0.0, 0.0, 1e-6), core::MisuseError);
}

}  // namespace
}  // namespace locate_test
