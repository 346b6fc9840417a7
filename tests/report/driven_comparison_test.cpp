// Trees of driven families, which have one period: few numbers tell their orbits apart, and multipliers are large.
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/report/compare/comparison.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/driven_oscillator.hpp"
#include "survey/atlas.hpp"

namespace driven_comparison_test {
namespace {

using namespace orbweaver;

std::filesystem::path surveyed(const std::string& damping, const std::string& setting) {
  systems::add_recorded<test::DrivenOscillator>();
  std::vector<std::string> settings{
      "system={name: driven_oscillator, parameters: {w: 1.056, a1: -1, a3: 1, a2: 0.253, d: " + damping + "}}",
      "starts={fixed_points: {grid: [[-1, 1], [0], [0]]}}",
      "continuation.free=F",
      "survey.depth=1",
      "survey.subharmonics=2",
      "limits.parameter=[0, 0.6]",
      "limits.period=30"};
  if (!setting.empty()) settings.push_back(setting);
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml", settings);
  const survey::Summary summary = test::run(core::Communicator(), scene, "compared" + setting);
  EXPECT_EQ(summary.failures, 0U);
  return summary.atlas;
}

// A double well: at folds the parameter turns by more than it changes from one orbit to the next, and a multiplier of
// 1e4 changes its sign.
TEST(DrivenComparison, OtherStepsAreNoDifference) {
  const archive::Archive a(surveyed("0.102", ""));
  const report::Comparison same = report::compare(a, archive::Archive(surveyed("0.102", "continuation.step=2deg")));
  for (const report::Difference& one : same.differences) ADD_FAILURE() << one.family_a << ": " << one.text;
  EXPECT_EQ(same.families, 4U);
  EXPECT_FALSE(report::compare(a, archive::Archive(surveyed("0.1021", ""))).same());
}

}  // namespace
}  // namespace driven_comparison_test
