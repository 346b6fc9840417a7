// Surveys from states that are good to two or three digits, beside equilibria and where errors grow fast.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace rough_starts_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;
using ::testing::Not;

struct Rough {
  std::string name;
  std::string system;
  std::string state;  ///< near the orbit with the energy and the period below, angles in degrees
  double guessed_period;
  double period;
  double energy;
  double rest;  ///< energy at which the family begins
};

class RoughStarts : public testing::TestWithParam<Rough> {};

/// All orbits of these families have nearly one period, so that none, or a far one, has exactly the guessed one.
TEST_P(RoughStarts, LeadToTheFamily) {
  const Rough& rough = GetParam();
  const core::Communicator comm;
  const scene::Scene scene =
      scene::parse(fmt::format("system: {{{}}}\nstarts: {{states: [{{state: [{}], period: {}, name: Rough}}]}}\n"
                               "survey: {{depth: 0, subharmonics: 1}}\nlimits: {{steps: 2}}\n",
                               rough.system, rough.state, rough.guessed_period),
                   "rough.yaml");
  const survey::Summary summary = test::run(comm, scene, "rough");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  ASSERT_EQ(summary.families.size(), 1U);
  const test::Atlas atlas(summary.atlas);
  const auto& steps = atlas.orbits().integers("step");
  const auto row = static_cast<std::size_t>(std::find(steps.begin(), steps.end(), 0) - steps.begin());
  ASSERT_LT(row, steps.size());
  // T of small orbits is a line in E.
  const double amplitude = (atlas.orbits().reals("energy")[row] - rough.rest) / (rough.energy - rough.rest);
  EXPECT_NEAR(amplitude, 1.0, 0.3);
  EXPECT_NEAR(atlas.orbits().reals("period")[row], rough.period, 0.005 * rough.period);
}

INSTANTIATE_TEST_SUITE_P(
    Systems, RoughStarts,
    testing::Values(Rough{"chain", "name: pendulum_chain, parameters: {links: 4}", "0.89, 1.1, 1.32, 1.58, 0, 0, 0, 0",
                          11.0, 11.0635301, -9.9980537, -10.0},
                    Rough{"heavy", "name: double_pendulum, parameters: {m1: 2000, m2: 30, l1: 120, l2: 40, g: 9.81}",
                          "0.02, -2.47, 0, 0", 12.4, 12.5492165, -2401476.7027, -2401488.0},
                    Rough{"halo", "name: cr3bp", "0.925, -0.004, 0.078, -0.003, -0.347, -0.005", 2.784, 2.7783971,
                          -1.5324011, -1.5866}),
    [](const auto& rough) { return rough.param.name; });

/// What a scene whose only state leads to no orbit is told.
std::string told(const std::string& scene) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, scene::parse(scene + "survey: {depth: 0}\n", "far.yaml"), "far");
  EXPECT_EQ(summary.failures, 1U);
  EXPECT_EQ(summary.failed_tasks.size(), 1U);
  return summary.failed_tasks.empty() ? "" : summary.failed_tasks.front();
}

TEST(FarStarts, AreToldWhatToTry) {
  const std::string driven = told(
      "system: {name: duffing, effects: [damping, drive], parameters: {damping: 0.1, drive_amplitude: 0.3, "
      "drive_frequency: 0.5}}\nstarts: {states: [{state: [5, 3, 0], period: 12.566}]}\n"
      "continuation: {free: drive_frequency}\nlimits: {parameter: [0.3, 3]}\n");
  EXPECT_THAT(driven, HasSubstr("after the given period the trajectory is "));
  EXPECT_THAT(driven, HasSubstr("the period should be a multiple of the drive's, 12.5663706"));
  EXPECT_THAT(driven, HasSubstr("a state at which a trajectory has settled"));
  const std::string conservative =
      told("system: {name: swinging_spring}\nstarts: {states: [{state: [0.3, -1, 2, 4], period: 1.5}]}\n");
  EXPECT_THAT(conservative, HasSubstr("after the given period the trajectory is "));
  EXPECT_THAT(conservative, HasSubstr("let starts.recurrences look for some (docs/starts.md"));
  EXPECT_THAT(conservative, Not(HasSubstr("drive")));
}

}  // namespace
}  // namespace rough_starts_test
