// Where the first orbit of a family is asked for decides nothing: not far out, nor where rounding hides it.
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "survey/atlas.hpp"
#include "survey/rotator.hpp"
#include "survey/same_tree.hpp"
#include "survey/scenes.hpp"

namespace first_orbits_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::Not;

survey::Summary survey_of(const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  survey::Summary summary = test::run(comm, test::quick_scene(overrides), "first");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  return summary;
}

TEST(FirstOrbits, FarOutNothingBetweenThemAndTheEquilibriumIsLost) {
  const std::vector<std::string> common{"limits.period=15", "survey.subharmonics=4"};
  const auto at = [&](const std::string& start) {
    std::vector<std::string> overrides = common;
    overrides.push_back("continuation.start=" + start);
    return test::Atlas(survey_of(overrides).atlas);
  };
  const test::Atlas near = at("0.5deg");
  ASSERT_GE(near.crossings().rows(), 6U);
  for (const std::string start : {"30deg", "60deg", "90deg"}) {
    SCOPED_TRACE(start);
    test::expect_same_tree(near, at(start));
  }
}

// A double pendulum on springs, in mm: on one side of a crossing of order 3 an index of 2.04 at the first orbit is
// -0.24 at the second. What lies between was taken for the birth.
TEST(FirstOrbits, WhatIsPassedOnTheFirstStepIsNotTheBirth) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
      {"system.effects=[torsion_springs]",
       "system.parameters={m1: 3, m2: 1.7, l1: 250, l2: 180, g: 9810, spring1: 2.6e7, spring2: 0.7e7, rest1: 1.1, "
       "rest2: -0.6}",
       "starts.fixed_points.grid=[[0.5], [0]]", "starts.fixed_points.names={}", "starts.fixed_points.letters={}",
       "starts.sweep.period=auto", "continuation={}", "survey.depth=2", "survey.subharmonics=4", "limits.period=5",
       "limits.energy=[-.inf, 2e7]"});
  const survey::Summary summary = test::run(comm, scene, "springs");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  const test::Atlas atlas(summary.atlas);
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 1 D3T3", "branch-point", 4.615477929).has_value());
}

scene::Scene springs_in_ms(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{
      "system.effects=[torsion_springs]",
      "system.parameters={m1: 3, m2: 1.7, l1: 250, l2: 180, g: 9.81e-3, spring1: 26, spring2: 7, rest1: 1.1, "
      "rest2: -0.6}",
      "starts.fixed_points.grid=[[0.5], [0]]",
      "starts.fixed_points.names={}",
      "starts.fixed_points.letters={}",
      "starts.sweep.period=auto",
      "continuation={}",
      "survey.depth=2"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml", all);
}

// E rises from orbit to orbit, at half the rate of the way before and less behind; in between it falls by 4e-4 of
// itself.
TEST(FirstOrbits, APairOfFoldsWithinAStepIsFoundWhereItsSlopesAreSmall) {
  const core::Communicator comm;
  const scene::Scene scene =
      springs_in_ms({"survey.subharmonics=3", "limits.period=4700", "limits.energy=[-.inf, 20]"});
  const survey::Summary summary = test::run(comm, scene, "springs");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  const test::Atlas atlas(summary.atlas);
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 1 D1T3", "fold-energy", 4567.15882).has_value());
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 1 D1T3", "fold-energy", 4569.60070).has_value());
}

// Steps a third of a family long pass indices of 118, -10 and 52.
TEST(FirstOrbits, LongStepsLoseNothing) {
  const core::Communicator comm;
  const auto by = [&](const std::string& step) {
    const survey::Summary summary = test::run(comm,
                                              springs_in_ms({"survey.subharmonics=4", "limits.period=6100",
                                                             "limits.energy=[-.inf, 24]", "continuation.step=" + step}),
                                              "steps");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    return test::Atlas(summary.atlas);
  };
  constexpr double depth_of_well = 9.8;  // -E at rest
  const test::Atlas usual = by("adaptive");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 1 D1T4b", "branch-point", 6097.252935).has_value());
  for (const std::string step : {"0.125", "0.25"}) {
    SCOPED_TRACE(step);
    test::expect_same_tree(usual, by(step), 1.0, 1.0, depth_of_well);
  }
}

// On one side of where Cap and Cup are gone around three times (T = 17.22, 25.92) E and T turn beside the birth, nearer
// than the first orbits of the larger start.
TEST(FirstOrbits, FarOutNoFoldBesideABirthIsLost) {
  const core::Communicator comm;
  const auto at = [&](const std::string& start) {
    const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml",
                                           {"continuation.start=" + start, "limits.energy=[-.inf, 0.1]"});
    const survey::Summary summary = test::run(comm, scene, "spring");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    return test::Atlas(summary.atlas);
  };
  const test::Atlas near = at("0.01");
  ASSERT_TRUE(near.crossing("AT3-2", "fold-energy", 17.22803947).has_value());
  ASSERT_TRUE(near.crossing("AT3-2", "fold-period", 17.21138397).has_value());
  ASSERT_TRUE(near.crossing("UT3-2", "fold-energy", 25.9166387).has_value());
  test::expect_same_tree(near, at("0.3"));
}

TEST(FirstOrbits, FarOutNoFoldBesideAnEquilibriumIsLost) {
  const core::Communicator comm;
  for (const std::string start : {"0.01", "0.5"}) {
    SCOPED_TRACE(start);
    const scene::Scene scene = scene::parse(
        "system: {name: harmonic_oscillator, scales: {time: 1, q: 1, energy: 1}}\n"
        "starts: {fixed_points: {grid: [[0]]}, sweep: {period: [6, 6.5], step: 0.05}}\n"
        "continuation: {start: " +
            start +
            "}\n"
            "compute: {certificate: none}\n"
            "limits: {energy: [-.inf, 0.2]}\n",
        "rotator", {});
    const auto folder = test::fresh_folder("rotator", comm.get());
    const survey::Summary summary =
        survey::run_survey(comm, scene, std::make_shared<const test::Rotator>(), folder, {});
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    const test::Atlas atlas(summary.atlas);
    ASSERT_EQ(atlas.crossings().rows(), 1U);
    EXPECT_EQ(atlas.crossings().texts("kind")[0], "fold-period");
    EXPECT_NEAR(atlas.crossings().reals("period")[0], 2.0 * std::numbers::pi / 1.001, 1e-10);
  }
}

TEST(FirstOrbits, FarOutNoOrbitThatIsAskedForIsLost) {
  constexpr double wanted = 8.2095;  // the in-phase oscillation has 8.20937
  const test::Atlas atlas(survey_of({"continuation.start=60deg", "limits.period=15", "survey.subharmonics=1",
                                     fmt::format("events.periods=[{}]", wanted)})
                              .atlas);
  const std::vector<double> periods = atlas.column("period", "In-Phase");
  EXPECT_THAT(periods, Contains(testing::DoubleNear(wanted, 1e-12)));
}

TEST(FirstOrbits, BelowRoundingAreToldOfOnceAFamily) {
  const survey::Summary summary =
      survey_of({"continuation.start=1e-14rad", "limits.steps=2", "compute.certificate=none"});
  const auto told_of = [](const std::string& family) {
    return testing::StartsWith(family + ": a first orbit at continuation.start would be lost in rounding: it is");
  };
  EXPECT_THAT(summary.remarks, Contains(told_of("Down-Up")).Times(1)) << "beside (0, pi)";
  EXPECT_THAT(summary.remarks, Not(Contains(told_of("In-Phase")))) << "beside (0, 0)";
}

}  // namespace
}  // namespace first_orbits_test
