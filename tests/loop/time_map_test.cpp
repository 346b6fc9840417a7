#include "orbweaver/loop/curve/time_map.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::loop::time_map_test {
namespace {

using test::two_pi;

std::vector<TimeMap> maps() {
  return {{}, {1.7, {}}, {0.3, {}}, {8.0, {}}, {1.0, {0.4, -0.2, 0.0, 0.1}}, {2.5, {0.05, 0.1, -0.1, 0.0, 0.02, 0.03}}};
}

// psi + ... with tan psi = kappa tan s, the branch taken from s.
double phase_by_definition(const TimeMap& map, double s) {
  const double turns = std::round(s / two_pi);
  double out = std::atan2(map.kappa * std::sin(s), std::cos(s)) + two_pi * turns;
  for (std::size_t k = 1; 2 * k <= map.coefficients.size(); ++k) {
    const double x = static_cast<double>(k);
    out += (map.coefficients[2 * k - 2] * std::sin(x * s) + map.coefficients[2 * k - 1] * (1 - std::cos(x * s))) / x;
  }
  return out;
}

TEST(TimeMap, IdentityByDefault) {
  const TimeMap map;
  EXPECT_TRUE(map.is_identity());
  for (const double s : {0.0, 1.3, -2.0, 9.9}) {
    EXPECT_EQ(map.phase(s), s);
    EXPECT_EQ(map.density(s), 1.0);
    EXPECT_NEAR(map.inverse(s), s, 1e-15 * std::abs(s));
  }
  EXPECT_TRUE((TimeMap{1.0, {0.0, 0.0}}).is_identity());
  EXPECT_FALSE((TimeMap{1.1, {}}).is_identity());
  EXPECT_FALSE((TimeMap{1.0, {0.0, 0.1}}).is_identity());
}

// Fitted to an orbit of the double pendulum. The phase has a step near s = 4, on either side of which Newton's method
// jumps to the other side, again and again.
TimeMap with_a_step() {
  return {1.0, {-0.12, -0.60, 0.32,  0.51,  0.45,  -0.20, -0.22, -0.07, 0.22,  0.16,  0.08, -0.21, -0.16, 0.10,
                0.14,  0.08,  -0.10, -0.14, -0.08, 0.10,  0.11,  -0.05, -0.03, -0.06, 0.04, 0.04,  0.05,  -0.04,
                -0.02, 0.00,  0.03,  0.01,  0.02,  -0.04, 0.00,  0.00,  0.02,  -0.01, 0.00, -0.01}};
}

TEST(TimeMap, InverseWhereThePhaseHasAStep) {
  const TimeMap map = with_a_step();
  for (int n = 0; n <= 2000; ++n) {
    const double wanted = two_pi * n / 2000;
    EXPECT_NEAR(map.phase(map.inverse(wanted)), wanted, 1e-14 * (1.0 + wanted));
  }
}

// Fejer's kernel, but for a floor: the density falls to floor / (1 + floor) between bumps, as one to a harmonic, and
// does so to rounding beside close approaches.
TimeMap with_flats(int harmonics, double floor) {
  TimeMap map;
  for (int k = 1; k <= harmonics; ++k) {
    map.coefficients.push_back(2.0 * (1.0 - k / (harmonics + 1.0)) / (1.0 + floor));
    map.coefficients.push_back(0.0);
  }
  return map;
}

TEST(TimeMap, InverseWhereThePhaseIsFlat) {
  for (const double floor : {0.0, 1e-12, 1e-6})
    for (const int harmonics : {20, 200}) {
      const TimeMap map = with_flats(harmonics, floor);
      // Of the phase, 8 roundings a harmonic, where Newton's method stops and where it steps to.
      const double rounding = 4e-15 * harmonics;
      for (int n = 0; n <= 4 * (harmonics + 1); ++n) {  // every fourth phase is a flat's own
        const double wanted = two_pi * n / (4 * (harmonics + 1));
        EXPECT_NEAR(map.phase(map.inverse(wanted)), wanted, rounding) << harmonics << ", " << floor;
      }
    }
}

TEST(TimeMap, PhaseIsItsDefinition) {
  for (const TimeMap& map : maps())
    for (const double s : {0.0, 0.1, 1.5, 1.6, 3.0, 3.2, 4.7, 6.2, -0.4, 7.0})
      EXPECT_NEAR(map.phase(s), phase_by_definition(map, s), 4e-15) << map.kappa << " at " << s;
}

TEST(TimeMap, DensityIsPositiveTheSlopeOfThePhaseAndOneInTheMean) {
  for (const TimeMap& map : maps()) {
    double sum = 0.0;
    const int nodes = 1000;
    const std::vector<double> at_nodes = densities(map, nodes);
    for (int j = 0; j < nodes; ++j) {
      const double s = two_pi * j / nodes;
      EXPECT_GT(map.density(s), 0.0);
      EXPECT_NEAR(at_nodes[static_cast<std::size_t>(j)], map.density(s), 1e-13);
      sum += map.density(s);
    }
    EXPECT_NEAR(sum / nodes, 1.0, 1e-14);
    for (const double s : {0.1, 1.5, 3.0, 4.7}) {
      const double h = 1e-5;
      EXPECT_NEAR((map.phase(s + h) - map.phase(s - h)) / (2.0 * h), map.density(s), 1e-7);
    }
    EXPECT_NEAR(map.phase(two_pi), two_pi, 1e-14);
    EXPECT_EQ(map.phase(0.0), 0.0);
  }
}

TEST(TimeMap, InverseUndoesPhase) {
  for (const TimeMap& map : maps())
    for (const double s : {0.0, 1e-9, 0.4, 1.57, 1.58, 3.1, 3.2, 4.0, 6.28, -0.3, -40.0, 100.0})
      EXPECT_NEAR(map.inverse(map.phase(s)), s, 2e-15 * (1.0 + std::abs(s)) / std::min(1.0, map.density(s)))
          << map.kappa << " at " << s;
}

TEST(TimeMap, ShiftedAndReversedFollowTheCurve) {
  for (const TimeMap& map : maps())
    for (const double shift : {0.5, -1.0, two_pi / 4, two_pi / 2, two_pi / 3}) {
      const TimeMap moved = map.shifted(shift);
      for (const double s : {0.0, 0.3, 2.0, 5.0}) {
        EXPECT_NEAR(moved.phase(s), map.phase(s + shift) - map.phase(shift), 2e-14) << map.kappa << ", " << shift;
        EXPECT_NEAR(map.reversed().phase(s), -map.phase(-s), 1e-15);
      }
    }
}

TEST(TimeMap, KnowsItsInvariance) {
  const TimeMap pulse{3.0, {}};
  const TimeMap third{1.0, {0.0, 0.0, 0.0, 0.0, 0.2, 0.1}};
  for (const double turns : {0.0, 0.5, 1.0, -0.5, 1.5}) EXPECT_TRUE(pulse.is_invariant_under_shift(turns)) << turns;
  for (const double turns : {0.25, 1.0 / 3.0, 0.51}) EXPECT_FALSE(pulse.is_invariant_under_shift(turns)) << turns;
  for (const double turns : {1.0 / 3.0, 2.0 / 3.0, 1.0}) EXPECT_TRUE(third.is_invariant_under_shift(turns)) << turns;
  EXPECT_FALSE(third.is_invariant_under_shift(0.5));
  EXPECT_EQ(pulse.shifted(two_pi / 2), pulse);
  EXPECT_EQ(third.shifted(two_pi / 3), third);
  EXPECT_EQ(pulse.reversed(), pulse);
  EXPECT_NE(third.reversed(), third);
}

TEST(TimeMap, IsResolvedByItsNodes) {
  for (const TimeMap& map : maps()) {
    const int nodes = nodes_to_resolve(map) + nodes_to_resolve(map) % 2 + 2;
    double sum = 0.0;
    for (const double w : densities(map, nodes)) sum += w;
    EXPECT_NEAR(sum / nodes, 1.0, 4e-15) << map.kappa;
  }
}

TEST(TimeMap, NumbersMakeTheRoundTrip) {
  EXPECT_TRUE(to_numbers({}).empty());
  EXPECT_TRUE(time_map_of({}).is_identity());
  for (const TimeMap& map : maps()) EXPECT_EQ(time_map_of(to_numbers(map)), map);
  EXPECT_EQ(to_numbers({2.0, {0.1, 0.2}}), (std::vector<double>{2.0, 0.1, 0.2}));
}

TEST(TimeMapMisuse, BadNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& bad :
       {std::vector<double>{0.0}, {-1.0}, {nan}, {1.0, 0.1}, {1.0, 0.1, nan}, {1.0, 1.1, 0.0}, {1.0, 0.0, -1.1}})
    EXPECT_THROW(static_cast<void>(time_map_of(bad)), core::MisuseError) << ::testing::PrintToString(bad);
  EXPECT_THROW(static_cast<void>(densities({1.0, {0.1, 0.1, 0.1, 0.1}}, 4)), core::MisuseError);
}

// Density (1 - cos s)(1 - cos 3s), whose coefficients are exact: small near s = 0.
TEST(TimeMap, SmallDensitiesKeepTheirDigits) {
  const TimeMap map{1.0, {-1.0, 0.0, 0.5, 0.0, -1.0, 0.0, 0.5, 0.0}};
  const auto exact = [](double s) { return std::pow(2.0 * std::sin(0.5 * s) * std::sin(1.5 * s), 2); };
  for (const double s : {0.01, 0.05, 0.3, 6.2}) EXPECT_NEAR(map.density(s), exact(s), 1e-11 * exact(s)) << s;
  const std::vector<double> nodal = densities(map, 400);
  for (std::size_t j = 1; j < nodal.size(); ++j) {
    const double s = two_pi * static_cast<double>(j) / 400.0;
    EXPECT_NEAR(nodal[j], exact(s), 1e-11 * exact(s)) << s;
  }
}

TEST(TimeMap, ParametersAtTheSameTime) {
  constexpr double least = 1.0 / 4096.0;
  TimeMap sharp{1.0, {-1.0, 0.0, 0.5, 0.0, -1.0, 0.0, 0.5, 0.0}};
  for (double& c : sharp.coefficients) c *= 1.0 - least;
  // The phase near 2 pi is rounded to 1e-15, which the density 2.6e-4 there makes 4e-12 of s.
  for (const double s : {0.05, 3.0, two_pi - 0.05}) EXPECT_NEAR(sharp.parameter_at(sharp, s), s, 1e-13);
  for (const TimeMap& map : maps())
    for (const TimeMap& other : maps())
      for (const double s : {0.2, 1.9, 4.0}) EXPECT_NEAR(map.phase(map.parameter_at(other, s)), other.phase(s), 1e-14);
}

// More than are taken together, beyond a turn on both sides, and where Newton's method needs its bracket.
TEST(TimeMap, ManyAtOnceAreThoseOneByOne) {
  std::vector<double> s;
  for (int n = -50; n < 150; ++n) s.push_back(two_pi * (n + 0.3) / 99.0);
  TimeMap sharp{1.0, {-1.0, 0.0, 0.5, 0.0, -1.0, 0.0, 0.5, 0.0}};
  for (double& c : sharp.coefficients) c *= 1.0 - 1.0 / 4096.0;
  std::vector<TimeMap> all = maps();
  all.push_back(with_a_step());
  all.push_back(sharp);
  for (std::size_t m = 0; m < all.size(); ++m) {
    const std::vector<double> phases = all[m].phases(s);
    ASSERT_EQ(phases.size(), s.size());
    for (std::size_t j = 0; j < s.size(); ++j) EXPECT_NEAR(phases[j], all[m].phase(s[j]), 1e-14) << m << " at " << s[j];
    for (const TimeMap& other : all) {
      const std::vector<double> at = all[m].parameters_at(other, s);
      ASSERT_EQ(at.size(), s.size());
      for (std::size_t j = 0; j < s.size(); ++j)
        EXPECT_NEAR(all[m].phase(at[j]), other.phase(s[j]), 3e-14) << m << " at " << s[j];
    }
  }
}

}  // namespace
}  // namespace orbweaver::loop::time_map_test
