// A chain of four pendulums, eight coordinates: more than every other system of the registry has.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"

namespace pendulum_chain_test {
namespace {

using namespace orbweaver;

constexpr int links = 4;
constexpr double rest = -10.0;

TEST(PendulumChain, ItsNormalModesAreFollowedFromRest) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                                         {"system.parameters.links=4", "limits.energy=[-.inf, -9.5]"});
  const survey::Summary summary = test::run(comm, scene, "chain");
  EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << "no task failed, nothing contradicts";
  ASSERT_EQ(summary.families.size(), 4U);
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.header().state_names.size(), 2U * links);
  EXPECT_EQ(atlas.header().pairs, links - 1);

  // Zeros of 24 L_4(x) = x^4 - 16 x^3 + 72 x^2 - 96 x + 24.
  const std::vector<double> zeros{0.322547689619392312, 1.745761101158346576, 4.536620296921127983,
                                  9.395070912301133129};
  for (int mode = 0; mode < links; ++mode) {
    const std::string family = fmt::format("Equilibrium 1, mode {}", mode + 1);
    const std::vector<double> period = atlas.column("period", family);
    const std::vector<double> energy = atlas.column("energy", family);
    const double linear = 2.0 * std::numbers::pi / std::sqrt(zeros[static_cast<std::size_t>(mode)]);
    ASSERT_GE(period.size(), 3U);
    EXPECT_EQ(atlas.end_of(family), "energy limit (E = -9.5)");
    EXPECT_NEAR(energy.back(), -9.5, 1e-12);
    // T is smooth in E - rest: a line through the first two orbits leads to the linear period at rest.
    const double slope = (period[1] - period[0]) / (energy[1] - energy[0]);
    EXPECT_GT(energy[0], rest);
    EXPECT_LT(energy[0], rest + 1e-3);
    EXPECT_NEAR(period[0] - slope * (energy[0] - rest), linear, 1e-5 * linear) << family;
    EXPECT_GT(std::abs(period[0] - linear), 1e-7 * linear) << family;
  }
}

// Of sixteen links several short periods nearly are multiples of others: a search for the families along their
// combinations takes most of the time, and nothing that is asked for here depends on it.
TEST(PendulumChain, WhatIsOutsideTheRangeIsNotSearched) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                  {"system.parameters.links=16", "starts.sweep.period=[20.8, 21.6]", "starts.sweep.step=0.05",
                   "survey.subharmonics=1", "limits.steps=1", "limits.energy=[-.inf, .inf]"});
  const survey::Summary summary = test::run(comm, scene, "sixteen");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families.front().name, "Equilibrium 1, mode 1");
  EXPECT_THAT(summary.remarks, testing::Contains(testing::HasSubstr(": Equilibrium 1, mode 2 with T = ")));
  EXPECT_THAT(summary.remarks, testing::Contains(testing::HasSubstr("oscillations with T = ")))
      << "how many families these are, and so their names, is not known";
}

// Near E = -53.3005 of ten links an index touches 2 as (E - E_0)^2: a pair of multipliers passes 1 with a gap below
// their error bounds, 3e-9 to 1e-8.
TEST(PendulumChain, APairThatPassesOneToRoundingIsUndecided) {
  const core::Communicator comm;
  // By the limit, the search for the minimum ends on an orbit near the touch, or where none converges.
  for (const std::string limit : {"-53.0", "-53.1", "-53.2"}) {
    SCOPED_TRACE(limit);
    const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                                           {"starts.sweep.period=[16, 18]", "limits.energy=[-.inf, " + limit + "]"});
    const survey::Summary summary = test::run(comm, scene, "touching");
    EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    EXPECT_THAT(summary.findings,
                testing::Contains(
                    testing::AllOf(testing::Field(&survey::FindingSummary::kind, survey::FindingKind::undecided_event),
                                   testing::Field(&survey::FindingSummary::severity, survey::Severity::undecided),
                                   testing::Field(&survey::FindingSummary::text, testing::HasSubstr("T = 16.9")))));
    const test::Atlas atlas(summary.atlas);
    EXPECT_EQ(atlas.families().rows(), 1U);
    // Two Krein collisions lie 1e-5 apart in T, at E = -53.05163 and -53.05135: some steps show them.
    EXPECT_THAT(atlas.crossings().texts("kind"), testing::Each("krein"))
        << "none is listed that is not told from none";
    EXPECT_THAT(atlas.crossings().reals("energy"), testing::Each(testing::AnyOf(testing::DoubleNear(-53.05163, 1e-5),
                                                                                testing::DoubleNear(-53.05135, 1e-5))));
  }
}

}  // namespace
}  // namespace pendulum_chain_test
