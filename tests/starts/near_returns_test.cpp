#include "orbweaver/starts/near_returns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"

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

// Its shortest orbit, that of the words LR and RL, has T = 1.5586522107 (Viswanath 2003,
// doi:10.1088/0951-7715/16/3/314); in units of 1 the trajectory comes nowhere within 0.1 of it.
TEST(NearReturns, InItsOwnScalesLorenzsTrajectoryPassesTheShortestOrbit) {
  const std::shared_ptr<const systems::System> system = systems::make_system("lorenz");
  const std::vector<double> state{-13.7, -19.6, 27.0};
  const NearReturnOptions options{100.0, 1.5, 1.62, 0.1};
  const systems::Scales scales = trajectory_scales(*system, state, options);
  EXPECT_THAT(scales.coordinates, ::testing::ElementsAre(8.0, 8.0, 8.0));
  EXPECT_LT(scales.time, 1.0);
  const auto scaled = systems::scaled(system, scales);
  std::vector<double> told = state;
  for (std::size_t i = 0; i < told.size(); ++i) told[i] /= scales.coordinate(i);
  const auto closest = [](const std::vector<NearReturn>& found, double time) {
    double gap = std::numeric_limits<double>::infinity();
    for (const NearReturn& at : found) gap = std::min(gap, std::abs(at.time * at.order * time - 1.5586522107));
    return gap;
  };
  const double in = scales.time;
  const auto found = near_returns(*scaled, told, {100.0 / in, 1.5 / in, 1.62 / in, 0.1});
  EXPECT_LT(closest(found, in), 0.03);
  EXPECT_GT(found.size(), near_returns(*system, state, options).size());
}

TEST(NearReturns, AreRefusedWhereTheyTakeTooLong) {
  const auto system = systems::make_system("double_pendulum");
  EXPECT_THROW(static_cast<void>(near_returns(*system, {1.0, 1.0, 0.0, 0.0}, {1e6, 1.0, 1e2, 0.1})), core::InputError);
}

}  // namespace
}  // namespace orbweaver::starts::near_returns_test
