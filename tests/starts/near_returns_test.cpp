#include "orbweaver/starts/near_returns.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::starts::near_returns_test {
namespace {

constexpr double pi = std::numbers::pi;

// All of a harmonic oscillator's trajectory returns, to itself after a period and to its image S after half of it, so
// whatever is found of it is right.
TEST(NearReturns, OfTheOscillatorHaveItsPeriod) {
  const auto system = systems::make_system("harmonic_oscillator");
  const std::vector<NearReturn> found = near_returns(*system, {1.0, 0.0}, {40.0, 5.0, 7.0, 1e-2});
  ASSERT_FALSE(found.empty());
  bool direct = false;
  bool mirrored = false;
  for (const NearReturn& at : found) {
    EXPECT_NEAR(at.time * at.order, 2.0 * pi, 1e-3);
    EXPECT_LT(at.distance, 1e-2);
    (at.order == 1 ? direct : mirrored) = true;
  }
  EXPECT_TRUE(direct);
  EXPECT_TRUE(mirrored);
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::pow(i < 2 ? std::remainder(a[i] - b[i], 2.0 * pi) : a[i] - b[i], 2);
  return std::sqrt(sum);
}

TEST(NearReturns, AreMinimaOfTheDistanceModuloWholeTurns) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> start{5.0 * pi / 9.0, 0.0, 0.0, 1.142544217670493};
  const NearReturnOptions options{400.0, 1.0, 30.0, 0.2};
  const std::vector<NearReturn> found = near_returns(*system, start, options);
  ASSERT_GT(found.size(), 5U);
  for (const NearReturn& at : found) {
    EXPECT_LT(at.distance, options.tolerance);
    EXPECT_GE(at.time * at.order, options.period_from);
    EXPECT_LE(at.time * at.order, options.period_to);
  }
  // Twice the time holds what half of it does, up to those that end behind it.
  const std::vector<NearReturn> half = near_returns(*system, start, {200.0, 1.0, 30.0, 0.2});
  EXPECT_LT(half.size(), found.size());
  // Those of a smaller tolerance are among them.
  for (const NearReturn& near : near_returns(*system, start, {400.0, 1.0, 30.0, 0.1})) {
    bool known = false;
    for (const NearReturn& at : found)
      known = known || (at.begin == near.begin && distance(at.state, near.state) == 0.0);
    EXPECT_TRUE(known);
  }
}

TEST(NearReturns, AreRefusedWhereTheyTakeTooLong) {
  const auto system = systems::make_system("double_pendulum");
  EXPECT_THROW(static_cast<void>(near_returns(*system, {1.0, 1.0, 0.0, 0.0}, {1e6, 1.0, 1e2, 0.1})), core::InputError);
}

}  // namespace
}  // namespace orbweaver::starts::near_returns_test
