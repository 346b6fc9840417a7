// Double pendulums whose two motions are far apart in time, or whose masses are.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace ratios_test {
namespace {

using namespace orbweaver;

scene::Scene scene_with(std::vector<std::string> settings) {
  settings.insert(settings.begin(),
                  {"starts.sweep={}", "survey.depth=0", "survey.subharmonics=4", "starts.fixed_points.grid=[[0], [0]]",
                   "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}"});
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml", settings);
}

std::size_t count_of(const survey::Summary& summary, survey::Severity severity) {
  std::size_t count = 0;
  for (const survey::FindingSummary& finding : summary.findings) count += finding.severity == severity ? 1 : 0;
  return count;
}

// Kernels hold the fast motion, 63 times as fast as the orbit, of which the orbit itself has nothing; what is born has
// harmonics in bands about its multiples.
TEST(Ratios, FamiliesAreBornInAMotionThatTheOrbitLacks) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      scene_with({"system.parameters.m2=1000", "survey.depth=1", "limits.period=8.98", "limits.energy=[-.inf, -1800]"}),
      "fast");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::contradiction), 0U);
  const test::Atlas atlas(summary.atlas);
  for (const double period : {8.9200124, 8.9703876})
    EXPECT_TRUE(atlas.crossing("In-Phase", "branch-point", period).has_value()) << period;
  EXPECT_GE(summary.families.size(), 4U);
}

// The light outer bob drives the inner one in resonance at T = 3 T_inner: the family turns there, within 1e-3.
TEST(Ratios, AFamilyTurnsAtAResonanceItMeets) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, scene_with({"system.parameters.m2=1e-6", "limits.period=20", "limits.families=1"}), "light");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::contradiction), 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_GT(summary.families.front().level_to, -0.9) << "it has gone straight on";
}

// Two thousand times as fast: an index is not known well enough to tell what it passes.
TEST(Ratios, WhatRoundingHidesIsUndecided) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, scene_with({"system.parameters.m2=1e6", "limits.period=8.92", "limits.families=1"}), "heavy");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::contradiction), 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::undecided), 1U);
}

// So much faster that no grid of the slow motion resolves it: linear systems are solved as they are. At T = 10.12 the
// box scheme, beside a motion that its cells do not resolve, no longer gives orbits.
TEST(Ratios, AFamilyIsFollowedBesideAMotionThatItsCellsDoNotResolve) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, scene_with({"system.parameters.m2=1e6", "limits.period=10.4", "limits.families=1"}), "slow");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families.front().period_to, 10.4);
}

// Orbits beside the inverted short pendulum have one energy to rounding, which moves them by more than they are apart:
// that a family ends among them is said, and is no failure.
TEST(Ratios, OrbitsThatRoundingDoesNotTellApartEndAFamily) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm, scene_with({"system.parameters.l2=1e-3", "survey.depth=1", "survey.subharmonics=2", "limits.period=1.3"}),
      "short");
  if (!comm.is_root()) return;
  EXPECT_EQ(count_of(summary, survey::Severity::failure), 0U);
  EXPECT_GE(summary.families.size(), 2U) << "nothing left the crossing at T = 1.2715";
  EXPECT_GE(count_of(summary, survey::Severity::undecided), 1U);
}

scene::Scene slow_swing(const std::string& l2, const std::string& period, const std::string& start) {
  return scene_with({"system.parameters.l2=" + l2, "limits.period=" + period, "continuation.start=" + start,
                     "starts.sweep.period=[6, 7]", "survey.subharmonics=2"});
}

// The outer bob turns by two whole turns more in half a period: it passes every quarter of one, from whatever orbit.
TEST(Ratios, AllThatAFastPhasePassesIsFound) {
  const core::Communicator comm;
  std::size_t orbits = 0;
  for (const char* start : {"0.2deg", "0.5deg", "1.3deg"}) {
    const survey::Summary summary = test::run(comm, slow_swing("1e-4", "6.36", start), "fast_phase");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    EXPECT_EQ(count_of(summary, survey::Severity::undecided), 0U);
    const test::Atlas atlas(summary.atlas);
    for (const double period : {6.291870031, 6.307098151, 6.322729875, 6.338778954, 6.355260274})
      EXPECT_TRUE(atlas.crossing("In-Phase", "branch-point", period).has_value()) << period << " from " << start;
    for (const double period : {6.284403309, 6.299434459, 6.314862728, 6.330701343, 6.346964606})
      EXPECT_TRUE(atlas.crossing("In-Phase", "period-doubling", period).has_value()) << period << " from " << start;
    ASSERT_EQ(summary.families.size(), 1U);
    EXPECT_EQ(summary.crossings, 10) << start;
    orbits = std::max<std::size_t>(orbits, summary.families.front().orbits);
  }
  EXPECT_LT(orbits, 40U) << "a whole turn has stopped the branch";
}

// Ten times as fast no kernel is found where the multiplier passes 1 or -1: that it does is said.
TEST(Ratios, WhatAFastPhasePassesAndIsNotLocatedIsSaid) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, slow_swing("1e-5", "6.2885", "0.5deg"), "faster_phase");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::contradiction), 0U);
  EXPECT_EQ(count_of(summary, survey::Severity::undecided) + static_cast<std::size_t>(summary.crossings), 2U)
      << "of turns 224.25 and 224.5";
}

}  // namespace
}  // namespace ratios_test
