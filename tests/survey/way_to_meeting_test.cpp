// What lies between a family's last orbit and the orbit of another one that it meets gone around several times.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "support/oscillators_in_fields.hpp"
#include "survey/atlas.hpp"

namespace way_to_meeting_test {
namespace {

using namespace orbweaver;

// A branch that three turns of another end turns in T at E = 0.309758, between its last step and the meeting. Another
// model of it by shooting has the fold at T = 9.403024 too.
TEST(WayToMeeting, AFoldBehindTheLastStepLiesWithinItsFamily) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml",
                  {"starts.fixed_points.names={}", "starts.fixed_points.letters={}", "starts.sweep.period=auto",
                   "starts.fixed_points.grid=[[0], [0]]", "limits.energy=[0, 1.5]", "limits.period=40",
                   "survey.depth=1", "survey.subharmonics=4"});
  const auto folder = test::fresh_folder("way_to_meeting" + std::to_string(comm.size()), comm.get());
  const survey::Summary summary =
      survey::run_survey(comm, scene, test::oscillators_in_fields({{"a", 0.2}, {"b", -0.2}, {"c", 0.35}}), folder, {});
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const auto fold = atlas.crossing("Equilibrium 1, mode 2 D2", "fold-period", 9.403024);
  ASSERT_TRUE(fold.has_value());
  EXPECT_NEAR(atlas.crossings().reals("energy")[*fold], 0.309758, 1e-6);
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
    const auto family = static_cast<std::size_t>(atlas.crossings().integers("family")[row]);
    const std::string& name = atlas.families().texts("name")[family];
    EXPECT_LE(atlas.crossings().reals("arclength")[row], atlas.column("arclength", name).back()) << name;
  }
}

}  // namespace
}  // namespace way_to_meeting_test
