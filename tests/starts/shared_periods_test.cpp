#include "orbweaver/starts/shared_periods.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::starts::shared_periods_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double amplitude = 0.01;

/// Independent oscillators q'' = -stiffness q.
std::vector<SharedPeriod> of_stiffness(std::vector<double> stiffness, double r = amplitude) {
  const std::vector<double> origin(2 * stiffness.size(), 0.0);
  const test::Oscillators system(std::move(stiffness));
  return shared_periods(system, origin, linear_modes(system, origin), r);
}

std::vector<int> harmonics_of(const std::vector<double>& stiffness, double r = amplitude) {
  return of_stiffness(stiffness, r).front().harmonics;
}

using Harmonics = std::vector<int>;

TEST(SharedPeriods, OfRatiosUpToThree) {
  EXPECT_EQ(harmonics_of({1.0, 4.0}), (Harmonics{1, 2}));
  EXPECT_EQ(harmonics_of({1.0, 9.0}), (Harmonics{1, 3}));
  EXPECT_EQ(harmonics_of({1.0, 16.0}), (Harmonics{1}));
  EXPECT_EQ(harmonics_of({1.0, 1.0}), (Harmonics{1, 1}));
  EXPECT_EQ(harmonics_of({4.0, 9.0}), (Harmonics{1}));
  EXPECT_EQ(harmonics_of({1.0, 9.0, 4.0}), (Harmonics{1, 2, 3}));
  EXPECT_EQ(harmonics_of({1.0, 4.0, 4.0, 2.0}), (Harmonics{1, 2, 2}));
}

TEST(SharedPeriods, EachOscillationBeginsOne) {
  const std::vector<SharedPeriod> shared = of_stiffness({1.0, 4.0, 2.0});
  ASSERT_EQ(shared.size(), 3U);
  EXPECT_NEAR(shared[0].period, 2 * pi, 1e-14);
  ASSERT_EQ(shared[0].members.size(), 2U);
  EXPECT_EQ(shared[0].members[1].oscillation, 2U);
  EXPECT_EQ(shared[0].members[1].harmonic, 2);
  EXPECT_FALSE(shared[0].is_simple());
  EXPECT_TRUE(shared[1].is_simple());
  EXPECT_TRUE(shared[2].is_simple());
  EXPECT_NEAR(shared[2].period, pi, 1e-14);
}

TEST(SharedPeriods, NearlyToWhatTheAmplitudeTells) {
  const auto ratio = [](double n, double detuning) {
    return std::vector<double>{1.0, std::pow(n / (1.0 + detuning), 2)};
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(harmonics_of(ratio(2, sign * 0.04)), (Harmonics{1, 2}));
    EXPECT_EQ(harmonics_of(ratio(2, sign * 0.06)), (Harmonics{1}));
    EXPECT_EQ(harmonics_of(ratio(2, sign * 0.06), 1.0), (Harmonics{1})) << "0.05 at most";
    EXPECT_EQ(harmonics_of(ratio(2, sign * 0.04), 1e-3), (Harmonics{1}));
    EXPECT_EQ(harmonics_of(ratio(3, sign * 1e-7)), (Harmonics{1, 3}));
    EXPECT_EQ(harmonics_of(ratio(3, sign * 6e-4)), (Harmonics{1}));
    EXPECT_EQ(harmonics_of(ratio(1, sign * 4e-4)), (Harmonics{1, 1}));
    EXPECT_EQ(harmonics_of(ratio(1, sign * 6e-4)), (Harmonics{1}));
  }
}

// Detunings that orbits of the amplitude 0.01 do not tell, nearer ones do: 5 r^2.
TEST(SharedPeriods, ApartAtASmallerAmplitude) {
  for (const double detuning : {1e-6, -1e-4, 4e-4}) {
    const std::vector<SharedPeriod> shared = of_stiffness({1.0, std::pow(3.0 / (1.0 + detuning), 2)});
    ASSERT_EQ(shared.size(), 2U) << detuning;
    for (const SharedPeriod& each : shared) {
      EXPECT_TRUE(each.is_simple());
      EXPECT_NEAR(each.apart_below, std::sqrt(std::abs(detuning) / 5.0), 1e-3 * each.apart_below);
      EXPECT_EQ(each.together_from, 0.0);
    }
  }
}

TEST(SharedPeriods, TogetherBeyondWhereFamiliesTurn) {
  EXPECT_NEAR(of_stiffness({1.0, std::pow(3.0 / (1.0 + 1e-7), 2)})[0].together_from, 8e-3, 1e-15);
  EXPECT_EQ(of_stiffness({1.0, 9.0})[0].together_from, 0.0) << "exactly";
  EXPECT_EQ(of_stiffness({1.0, std::pow(2.0 / (1.0 + 1e-4), 2)})[0].together_from, 0.0) << "no turns";
  EXPECT_TRUE(std::isinf(of_stiffness({1.0, 9.0})[0].apart_below));
}

// With a small second mass both frequencies are nearly one, and both oscillations nearly those of the second angle.
TEST(SharedPeriods, NotOfVectorsThatNearlyAgree) {
  const auto system = systems::make_system("double_pendulum", {{"m2", 1e-8}});
  const std::vector<double> rest(4, 0.0);
  const LinearModes modes = linear_modes(*system, rest);
  ASSERT_LT(modes.oscillations[0].period / modes.oscillations[1].period, 1.0 + 2e-4);
  EXPECT_EQ(shared_periods(*system, rest, modes, amplitude).size(), 2U);
}

// L4's two oscillations just below Routh's mass ratio, of opposite energies, and a light pendulum's two, of one sign.
TEST(SharedPeriods, ApartWhereTheyAreAboutToCollide) {
  const double mu = 0.03852;
  const auto system = systems::make_system("pcr3bp", {{"mu", mu}});
  const std::vector<double> l4{0.5 - mu, std::sqrt(0.75), 0.0, 0.0};
  const LinearModes modes = linear_modes(*system, l4);
  const std::vector<SharedPeriod> shared = shared_periods(*system, l4, modes, amplitude);
  ASSERT_EQ(shared.size(), 2U);
  const double detuning = 1.0 - modes.oscillations[1].period / modes.oscillations[0].period;
  ASSERT_LT(detuning, 0.01);
  for (const SharedPeriod& each : shared) EXPECT_NEAR(each.apart_below, detuning / 5.0, 1e-9);
  const auto light = systems::make_system("double_pendulum", {{"m2", 1e-6}});
  const std::vector<double> rest(4, 0.0);
  for (const SharedPeriod& each : shared_periods(*light, rest, linear_modes(*light, rest), amplitude))
    EXPECT_TRUE(std::isinf(each.apart_below));
}

TEST(SharedPeriods, SignsOfTheEnergy) {
  EXPECT_TRUE(of_stiffness({1.0, 4.0})[0].is_definite);
  // L4 is a maximum along the slow oscillation and a minimum along the fast one; here their ratio is 2.
  const double mu = 0.024293897142052323;
  const auto system = systems::make_system("pcr3bp", {{"mu", mu}});
  const std::vector<double> l4{0.5 - mu, std::sqrt(0.75), 0.0, 0.0};
  const std::vector<SharedPeriod> shared = shared_periods(*system, l4, linear_modes(*system, l4), amplitude);
  ASSERT_EQ(shared.size(), 2U);
  EXPECT_EQ(shared[0].harmonics, (Harmonics{1, 2}));
  EXPECT_FALSE(shared[0].is_definite);
  EXPECT_TRUE(shared[1].is_definite);
}

TEST(SharedPeriods, Misuse) {
  const auto system = systems::make_system("henon_heiles");
  EXPECT_THROW(static_cast<void>(shared_periods(*system, std::vector<double>(3, 0.0), {}, amplitude)),
               core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::shared_periods_test
