#include <gmock/gmock.h>

#include <algorithm>

#include "survey/atlas.hpp"
#include "survey/widened.hpp"

namespace tree_limits_test {
namespace {

using namespace orbweaver;
using test::Atlas;
using test::quick_scene;
using test::run;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TreeLimits, OrbitsBornBeyondThePeriodLimitDoNotStart) {
  const core::Communicator comm;
  const survey::Summary summary = run(comm,
                                      quick_scene({"survey.depth=1", "survey.subharmonics=2", "limits.period=11",
                                                   "starts.fixed_points.grid=[[0],[0]]"}),
                                      "period");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  const Atlas atlas(summary.atlas);
  EXPECT_THAT(atlas.families().texts("name"), ElementsAre("In-Phase", "IB", "Out-Phase", "ODa", "ODb", "OB"));
  const auto doubling = atlas.crossing("In-Phase", "period-doubling", 8.44293);
  ASSERT_TRUE(doubling.has_value()) << "located all the same";
  EXPECT_EQ(atlas.crossings().integers("kernel_dimension")[*doubling], -1);
  EXPECT_THAT(atlas.orbits().reals("period"), Each(::testing::Le(11.0)));
}

TEST(TreeLimits, FamiliesBeyondTheLimitDoNotStart) {
  const core::Communicator comm;
  const survey::Summary summary = run(comm,
                                      quick_scene({"survey.depth=1", "survey.subharmonics=2", "limits.period=18",
                                                   "limits.families=4", "starts.fixed_points.grid=[[0],[0]]"}),
                                      "families");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  const Atlas atlas(summary.atlas);
  EXPECT_THAT(atlas.families().texts("name"), ElementsAre("In-Phase", "IDa", "IDb", "Out-Phase"));
}

TEST(TreeLimits, DepthCountsGenerations) {
  const core::Communicator comm;
  const std::vector<std::string> overrides{"survey.subharmonics=1", "limits.period=11",
                                           "starts.fixed_points.grid=[[0],[0]]"};
  for (const int depth : {0, 1, 2}) {
    std::vector<std::string> more = overrides;
    more.push_back("survey.depth=" + std::to_string(depth));
    const survey::Summary summary = run(comm, quick_scene(more), "depth" + std::to_string(depth) + ".");
    EXPECT_EQ(summary.failures, 0U);
    if (!comm.is_root()) continue;
    int deepest = 0;
    for (const survey::FamilySummary& family : summary.families) deepest = std::max(deepest, family.depth);
    EXPECT_EQ(deepest, depth);
    EXPECT_TRUE(Atlas(summary.atlas).crossing("In-Phase", "branch-point", 10.41677).has_value());
  }
}

// The family that is born on ID2a at T = 20.4531 passes an index of -2 at T = 20.5049: behind its first orbit with a
// first step of 0.1 degrees, before it with one of half a degree.
TEST(TreeLimits, CrossingsBeforeTheFirstOrbitAreFound) {
  const core::Communicator comm;
  for (const std::string first : {"0.1deg", "0.5deg", "1deg"}) {
    SCOPED_TRACE(first);
    const survey::Summary summary = run(comm,
                                        quick_scene({"survey.depth=2", "survey.subharmonics=2", "limits.period=21",
                                                     "limits.energy=[-.inf, 1.1]", "starts.fixed_points.grid=[[0],[0]]",
                                                     "starts.sweep.period=[8, 9]", "continuation.start=" + first}),
                                        "before_first");
    if (!comm.is_root()) continue;
    const Atlas atlas(summary.atlas);
    const auto& names = atlas.families().texts("name");
    const auto born =
        std::find_if(names.begin(), names.end(), [](const std::string& name) { return name.ends_with("aB"); });
    ASSERT_NE(born, names.end());
    const auto crossing = atlas.crossing(*born, "period-doubling", 20.50491);
    ASSERT_TRUE(crossing.has_value());
    EXPECT_NEAR(atlas.crossings().reals("period")[*crossing], 20.504913670296, 1e-9);
    const bool is_before = atlas.column("period", *born).front() > 20.504914;
    EXPECT_EQ(is_before, first != "0.1deg");
    EXPECT_EQ(atlas.crossings().reals("arclength")[*crossing] < 0.0, is_before);
  }
}

// Eight orbits leave the origin, which are three up to the symmetries of the triangle and time reversal.
TEST(HenonHeiles, HasThreeFamiliesAtTheOrigin) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", {"starts.sweep.step=0.05"});
  const survey::Summary summary = run(comm, scene, "henon_heiles");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  std::vector<std::string> isotropies;
  for (const survey::FamilySummary& family : summary.families) {
    EXPECT_THAT(family.end_reason, HasSubstr("energy limit (E = 0.15)"));
    if (family.depth == 0) isotropies.push_back(family.isotropy);
  }
  EXPECT_THAT(isotropies, ElementsAre("S@0 R@0", "S@1/2 R@0", "C@1/3 RS@0"));
  const Atlas atlas(summary.atlas);
  // Families with two sides run through the crossing where they were born.
  const auto sides = std::find_if(summary.families.begin(), summary.families.end(),
                                  [](const auto& f) { return f.end_reason.starts_with("forwards: "); });
  ASSERT_NE(sides, summary.families.end());
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[atlas.row_of(sides->name)]);
  EXPECT_LT(atlas.orbits().integers("step")[first], 0);
  EXPECT_LT(atlas.orbits().reals("arclength")[first], 0.0);
}

// The third family from Straight's crossing at T = 7.521 goes over to another one at its second step, which passes
// E = 0.13804: the step is taken back, and how much shorter the next one is depends on the limit.
TEST(HenonHeiles, WiderLimitsBehindAStepThatMetOneAndWasTakenBack) {
  const auto scene_with = [](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"starts.sweep.step=0.05", "continuation.start=0.03"});
    return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", overrides);
  };
  test::expect_same_when_widened(core::Communicator(), scene_with, {"limits.energy=[-.inf, 0.138038453]"});
}

}  // namespace
}  // namespace tree_limits_test
