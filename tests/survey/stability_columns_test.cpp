#include "tasks/stability_columns.hpp"
#include "tasks/orbit_row.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "spectrum/point_systems.hpp"

namespace stability_columns_test {
namespace {

using namespace orbweaver;

constexpr double pi = std::numbers::pi;

loop::Loop oscillation(int dimension) {
  loop::Loop loop = loop::constant_loop(std::vector<double>(static_cast<std::size_t>(dimension), 0.0), 2 * pi, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 1) = -1.0;
  return loop;
}

TEST(StabilityColumns, OnePairIsOneRealIndex) {
  const double omega = 0.37;
  const test::Oscillators system({1.0, omega * omega});
  archive::OrbitRecord row;
  survey::set_stability(system.structure(), survey::stability_of(system, oscillation(4), {}), row);
  ASSERT_EQ(row.stability.size(), 1U);
  EXPECT_NEAR(row.stability[0], 2.0 * std::cos(2 * pi * omega), row.stability_error);
  EXPECT_EQ(row.fundamental_stability, row.stability);
  EXPECT_LE(row.stability_error, 1e-9);
}

TEST(StabilityColumns, SeveralPairsAreComplexAndShareTheLargestBound) {
  const double omega = 0.37;
  const test::Oscillators system({1.0, omega * omega, -0.25});
  archive::OrbitRecord row;
  survey::set_stability(system.structure(), survey::stability_of(system, oscillation(6), {}), row);
  ASSERT_EQ(row.stability.size(), 4U);
  EXPECT_NEAR(row.stability[0], 2.0 * std::cosh(pi), row.stability_error);
  EXPECT_NEAR(row.stability[2], 2.0 * std::cos(2 * pi * omega), row.stability_error);
  EXPECT_EQ(row.stability[1], 0.0);
  EXPECT_EQ(row.stability[3], 0.0);
  EXPECT_EQ(row.fundamental_stability.size(), 4U);
  EXPECT_LE(row.stability_error, 1e-8);
}

TEST(StabilityColumns, MultipliersOfADissipativeSystem) {
  const double growth = 0.3;
  const test::HopfCycle system(growth, 1.0);
  loop::Loop loop = loop::constant_loop(std::vector<double>(3, 0.0), 2 * pi, 3);
  loop.cosine(1, 0) = std::sqrt(growth);
  loop.sine(1, 1) = std::sqrt(growth);
  archive::OrbitRecord row;
  survey::set_stability(system.structure(), survey::stability_of(system, loop, {}), row);
  ASSERT_EQ(row.stability.size(), 4U);
  EXPECT_NEAR(row.stability[0], std::exp(-4 * pi * growth), row.stability_error);
  EXPECT_NEAR(row.stability[2], std::exp(-2 * pi), row.stability_error);
}

TEST(StabilityColumns, WhatCannotBeComputedIsNaN) {
  const test::Oscillators system({1.0, std::numeric_limits<double>::quiet_NaN()});
  archive::OrbitRecord row;
  row.stability_error = 0.0;
  survey::set_stability(system.structure(), survey::stability_of(system, oscillation(4), {}), row);
  ASSERT_EQ(row.stability.size(), 1U);
  EXPECT_TRUE(std::isnan(row.stability[0]));
  EXPECT_TRUE(std::isnan(row.fundamental_stability[0]));
  EXPECT_TRUE(std::isnan(row.stability_error));
}

}  // namespace
}  // namespace stability_columns_test
