#include "orbweaver/loop/symmetry/standard_phase.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::standard_phase_test {
namespace {

using test::element_of;

const double irrational = std::sqrt(2.0) / 7.0;
constexpr double pi = std::numbers::pi;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }

Loop loop_with(const Isotropy& isotropy, const std::vector<double>& mean = {0.0, 0.0, 0.0, 0.0}) {
  return test::random_loop_in(Subspace(4, 8, isotropy), constant_loop(mean, 5.0, 8), 71);
}

// Whatever quarter the loop starts at, it is brought to rest with the first coordinate at its larger value.
TEST(StandardPhase, LiesOnTheFirstReversorsFixedSet) {
  const Loop loop = loop_with({element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")});
  const Loop expected = state_at(loop, 0.0)[0] > 0.0 ? loop : time_shifted(loop, 0.5);
  for (const double late : {0.0, 0.25, 0.5, 0.75}) {
    const Loop shifted = time_shifted(loop, late);
    const Isotropy isotropy = find_isotropy(pendulum(), shifted, 1e-9);
    ASSERT_EQ(isotropy.size(), 2u);
    EXPECT_LT(mean_distance(in_standard_phase(pendulum(), shifted, isotropy), expected), 1e-13) << late;
  }
  EXPECT_GT(state_at(expected, 0.0)[0], 0.0);
}

TEST(StandardPhase, TakesTheReversorThatProductsGive) {
  const Loop loop = loop_with({element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R", 1, 2)});
  const Isotropy without_r{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "RS")};
  const Loop standard = in_standard_phase(pendulum(), loop, without_r);
  const std::vector<double> z = state_at(standard, 0.0);
  EXPECT_NEAR(z[2], 0.0, 1e-14);
  EXPECT_NEAR(z[3], 0.0, 1e-14);
  EXPECT_GT(z[0], 0.0);
}

// Both points of RS's fixed set have th1 = th2 = 0 here: w1 decides.
TEST(StandardPhase, ComparesTheNextCoordinateWhereTheFirstAreEqual) {
  const Loop loop = loop_with({element_of(pendulum(), "RS")});
  const double here = state_at(loop, 0.0)[2];
  const double there = state_at(loop, 0.5 * loop.period)[2];
  ASSERT_GT(std::abs(here - there), 0.1);
  const Loop a = in_standard_phase(pendulum(), loop, {element_of(pendulum(), "RS")});
  EXPECT_NEAR(state_at(a, 0.0)[2], std::max(here, there), 1e-13);
  const Loop half = time_shifted(loop, 0.5);
  EXPECT_LT(mean_distance(in_standard_phase(pendulum(), half, {element_of(pendulum(), "RS")}), a), 1e-13);
}

TEST(StandardPhase, OfARotationPutsTheAngleAtPi) {
  Loop rotation = loop_with({element_of(pendulum(), "RS")});
  rotation.winding = {1.0, 0.0, 0.0, 0.0};
  for (const double late : {0.0, 0.5}) {
    const Loop shifted = time_shifted(rotation, late);
    const Loop standard = in_standard_phase(pendulum(), shifted, {element_of(pendulum(), "RS")});
    EXPECT_NEAR(std::remainder(state_at(standard, 0.0)[0], 2.0 * pi),
                std::copysign(pi, std::remainder(state_at(standard, 0.0)[0], 2.0 * pi)), 1e-12)
        << late;
  }
}

TEST(StandardPhase, KeepsAPulseMap) {
  const Isotropy both{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  const Loop loop = with_time_map(loop_with(both), {1.5, {}}, 60);
  const Loop a = in_standard_phase(pendulum(), loop, both);
  const Loop b = in_standard_phase(pendulum(), time_shifted(loop, 0.5), both);
  EXPECT_EQ(a.time_map, loop.time_map);
  EXPECT_EQ(b.time_map, loop.time_map);
  EXPECT_LT(mean_distance(a, b), 1e-13);
}

TEST(StandardPhase, WithoutReversorIsTheMaximumOfTheFirstAngle) {
  const Loop even = loop_with({});
  for (const Loop& loop : {even, with_time_map(even, {1.3, {0.1, 0.05}}, 60)}) {
    const Loop standard = in_standard_phase(pendulum(), loop, {});
    const double top = state_at(standard, 0.0)[0];
    for (int j = 1; j < 1000; ++j) EXPECT_LE(state_at(standard, 5.0e-3 * j)[0], top) << j;
    EXPECT_NEAR(state_at(standard, 1e-4)[0], state_at(standard, -1e-4)[0], 1e-10) << "the slope is zero";
    EXPECT_LT(mean_distance(standard, in_standard_phase(pendulum(), time_shifted(loop, irrational), {})), 1e-12);
  }
}

}  // namespace
}  // namespace orbweaver::loop::standard_phase_test
