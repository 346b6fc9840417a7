#include "orbweaver/continuation/way_from_start.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace orbweaver::continuation::way_from_start_test {
namespace {

/// Three times around an orbit, and a direction in which every third harmonic is missing.
Start around_three_times() {
  Start start;
  const std::vector<double> origin(2, 0.0);
  start.base = loop::constant_loop(origin, 18.0, 4);
  start.base.cosine(3, 0) = 1.0;
  start.base.sine(3, 1) = -1.0;
  loop::Loop direction = loop::constant_loop(origin, 18.0, 4);
  direction.cosine(1, 0) = 0.6;
  direction.sine(2, 1) = 0.8;
  start.direction.modes = direction.modes;
  start.times = 3;
  return start;
}

TEST(WayFromStart, WhatRepeatsAsTheBaseDoesSaysNothingOfTheDirection) {
  const Start start = around_three_times();
  loop::Loop orbit = start.base;
  orbit.cosine(1, 0) += 0.06;
  orbit.sine(2, 1) += 0.08;
  orbit.cosine(3, 0) += 0.3;  // 72 degrees aside
  const WayFromStart way = way_from(start, orbit);
  EXPECT_NEAR(way.share, 1.0, 1e-14);
  EXPECT_NEAR(way.share_of_whole, 0.1 / std::hypot(0.1, 0.3), 1e-14);
  EXPECT_FALSE(way.is_along_base());
  Start once = start;
  once.times = 1;
  EXPECT_NEAR(way_from(once, orbit).share, way.share_of_whole, 1e-14);
}

TEST(WayFromStart, OrbitsOfTheBasesFamilyLieAlongIt) {
  const Start start = around_three_times();
  loop::Loop orbit = start.base;
  orbit.cosine(3, 0) += 0.3;
  EXPECT_TRUE(way_from(start, orbit).is_along_base());
  orbit.cosine(1, 0) += 1e-9;  // rounding
  EXPECT_TRUE(way_from(start, orbit).is_along_base());
}

TEST(WayFromStart, AnotherDirectionLiesBeside) {
  const Start start = around_three_times();
  loop::Loop orbit = start.base;
  orbit.cosine(1, 0) += 0.08;
  orbit.sine(2, 1) -= 0.06;
  EXPECT_NEAR(way_from(start, orbit).share, 0.0, 1e-14);
}

}  // namespace
}  // namespace orbweaver::continuation::way_from_start_test
