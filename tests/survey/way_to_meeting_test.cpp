// What lies between a family's last orbit and the orbit of another one that it meets gone around several times.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/driven_oscillator.hpp"
#include "support/oscillators_in_fields.hpp"
#include "survey/atlas.hpp"

namespace way_to_meeting_test {
namespace {

using namespace orbweaver;

/// Families of a driven oscillator along its drive's amplitude, from an equilibrium, with their doublings.
struct Driven {
  survey::Summary summary;
  std::string wrong;      // contradictions
  std::string undecided;  // without those on multipliers that are large
};

Driven driven(const std::string& parameters, const std::string& place, const std::string& most,
              const std::string& longest) {
  systems::add_recorded<test::DrivenOscillator>();
  const core::Communicator comm;
  const scene::Scene scene = scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml",
      {"system={name: driven_oscillator, parameters: {" + parameters + "}}",
       "starts={fixed_points: {grid: [[" + place + "], [0], [0]]}}", "continuation.free=F", "survey.depth=2",
       "survey.subharmonics=2", "limits.parameter=[0, " + most + "]", "limits.period=" + longest});
  Driven out;
  out.summary = test::run(comm, scene, "driven");
  for (const survey::FindingSummary& line : out.summary.findings) {
    if (line.severity == survey::Severity::contradiction) out.wrong += line.text + "; ";
    const bool is_on_indices = line.text.find("a stability index is known") != std::string::npos;
    if (line.severity == survey::Severity::undecided && !is_on_indices) out.undecided += line.text + "; ";
  }
  return out;
}

// Its multiplier is -19862 at the last orbit, 1 at the meeting and -1 on the way; shooting has it at F = 0.476561877.
TEST(WayToMeeting, ADoublingBehindTheLastOrbitIsFound) {
  const Driven found = driven("w: 0.9942, d: 0.1518, a1: -1, a3: 1, a2: 0.00946", "-1", "0.6", "45");
  if (!core::Communicator().is_root()) return;
  EXPECT_EQ(found.summary.failures, 0U);
  EXPECT_EQ(found.wrong, "");
  const test::Atlas atlas(found.summary.atlas);
  double nearest = 1.0;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
    const auto family = static_cast<std::size_t>(atlas.crossings().integers("family")[row]);
    if (atlas.families().texts("name")[family] == "Equilibrium 1 DD1" &&
        atlas.crossings().texts("kind")[row] == "period-doubling")
      nearest = std::min(nearest, std::abs(atlas.crossings().reals("parameter")[row] - 0.476561877));
  }
  EXPECT_LT(nearest, 1e-8);
}

// A pendulum with a torque. D comes back to the first family at F = 1.305711946, and is doubled at 1.305711696: what is
// born there goes four times around an orbit of the first family, nearly. It meets D, and is one family, not two.
TEST(WayToMeeting, AFamilyThatComesNearTwoMeetsTheOneThatItComesFrom) {
  const Driven found = driven("w: 0.5735, d: 0.1853, s: 1, c: 0.3024", "0.3", "1.6", "50");
  if (!core::Communicator().is_root()) return;
  EXPECT_EQ(found.summary.failures, 0U);
  EXPECT_EQ(found.wrong, "");
  EXPECT_EQ(found.undecided, "");
  const test::Atlas atlas(found.summary.atlas);
  EXPECT_EQ(atlas.families().rows(), 4U);
  EXPECT_THAT(atlas.end_of("Equilibrium 1 DD2"), testing::StartsWith("joined Equilibrium 1 D at T = 43.82343"));
}

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
