// Families of the planar restricted problem that lead from one resonance of the short-period family to the next.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace bridges_test {
namespace {

using namespace orbweaver;

// From the crossing of order 13 one way leads along the long-period family, the other beside it. There an index is 7e-5
// from 2, and cells that hold all its harmonics do not tell its orbits from others. At T = 82.01 it passes the long
// family at a narrow gap, where the part of an orbit that goes around 13 times changes its sign, and goes on as long
// orbits do: to the next resonance (Henrard 2002). The short orbit of that was located on the short-period family.
class Bridges : public testing::TestWithParam<std::string> {};

TEST_P(Bridges, TheFamilyBesideTheLongOneEndsAtTheNextResonance) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
      {"continuation.start=" + GetParam(), "starts.fixed_points.grid=[[0.499], [0.866]]", "starts.sweep.period=[6, 80]",
       "starts.sweep.step=0.1", "survey.depth=1", "survey.subharmonics=13", "limits.period=120"});
  const survey::Summary summary = test::run(comm, scene, "beside");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  if (!comm.is_root()) return;
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_TRUE(line.severity != survey::Severity::failure && line.severity != survey::Severity::contradiction)
        << line.text;
  const test::Atlas atlas(summary.atlas);
  const std::string long_one = atlas.end_of("Long-4");
  EXPECT_NE(long_one.find("joined Short-4 at T = 81.7680229"), std::string::npos) << long_one;
  const std::string beside = atlas.end_of("SfT13");
  EXPECT_NE(beside.find("joined Short-4 at T = 88.0365268"), std::string::npos) << beside;
  EXPECT_NE(beside.find("14 times around"), std::string::npos) << beside;
}

INSTANTIATE_TEST_SUITE_P(FirstSteps, Bridges, testing::Values("0.003", "0.005", "0.01", "0.0103", "0.0127", "0.02"),
                         [](const auto& first) {
                           std::string name = first.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace bridges_test
