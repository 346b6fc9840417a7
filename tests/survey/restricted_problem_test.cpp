// The planar circular restricted three-body problem with mu = 0.001, whose loops pass near a body: what a tree says may
// not hang on the first step.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace {

using namespace orbweaver;

// Henrard 1973 and Deprit and Henrard 1968 have the short-period family of L4 end on a branch of L3's family.
TEST(RestrictedProblem, ShortFamiliesEndOnThatOfL3) {
  constexpr double branch_point = 6.281648688;
  const core::Communicator comm;
  for (const std::string first : {"0.0017", "0.0052", "0.0087", "0.0122", "0.0175"}) {
    SCOPED_TRACE(first);
    const scene::Scene scene =
        scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
                    {"continuation.start=" + first, "starts.fixed_points.grid=[[-1, 0.499], [-0.866, 0, 0.866]]",
                     "starts.fixed_points.names={[-1.0004166666, 0]: [L3], [0.499, 0.8660254038]: [Long-4, L4], "
                     "[0.499, -0.8660254038]: [Long-5, L5]}",
                     "starts.fixed_points.letters={}", "starts.sweep.period=[6.2, 6.5]", "starts.sweep.step=0.01",
                     "survey.depth=1", "survey.subharmonics=1", "limits.period=8"});
    const survey::Summary summary = test::run(comm, scene, "short");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    ASSERT_EQ(summary.families.size(), 3U);
    const test::Atlas atlas(summary.atlas);
    const auto crossing = atlas.crossing("L3", "branch-point", branch_point);
    ASSERT_TRUE(crossing.has_value());
    EXPECT_NEAR(atlas.crossings().reals("period")[*crossing], branch_point, 1e-9);
    EXPECT_EQ(atlas.crossings().rows(), 1U);
    for (const std::string family : {"L4", "L5"})
      EXPECT_NE(atlas.end_of(family).find("joined L3 at T = 6.28164868"), std::string::npos) << atlas.end_of(family);
  }
}

}  // namespace
