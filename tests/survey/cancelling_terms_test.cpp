// A system whose formulas lose digits near its equilibrium: rounding there is more than its coordinates let expect.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "support/toda_springs.hpp"
#include "survey/atlas.hpp"

namespace cancelling_terms_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;

survey::Summary survey_from(const std::string& start, double unit) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml",
      {"starts.fixed_points.names={}", "starts.fixed_points.letters={}", "starts.sweep.period=auto",
       "starts.fixed_points.grid=[[0], [0], [0], [0]]", "survey.depth=1", "limits.energy=[-.inf, 0.3]",
       "limits.period=20", "continuation.start=" + start});
  const auto system = test::toda_springs({{"w1", 1.0}, {"w2", 1.307}, {"c", -0.2309}, {"f", 1.2}, {"unit", unit}});
  return survey::run_survey(comm, scene, system, test::fresh_folder("cancelling_terms", comm.get()), {});
}

// Energies of 1e-10 of which each has terms of order 1.
TEST(CancellingTerms, SmallOrbitsAreNotContradictedByTheirEnergy) {
  const survey::Summary summary = survey_from("1e-5", 1.0);
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  const test::Atlas atlas(summary.atlas);
  EXPECT_LT(atlas.orbits().reals("energy").front(), 1e-9);
  EXPECT_THAT(atlas.orbits().integers("verdict"), Each(0));
}

// A length of the scene is one of the coordinate with the largest scale, 1e5: what looks like a hundredth is 1e-7.
TEST(CancellingTerms, FirstOrbitsLostInRoundingAreTakenFurtherOut) {
  for (const std::string start : {"1e-3", "1e-9"}) {
    SCOPED_TRACE(start);
    const survey::Summary summary = survey_from(start, 1e5);
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    EXPECT_THAT(summary.remarks, Contains(HasSubstr("would be lost in rounding: it is taken")));
    const test::Atlas atlas(summary.atlas);
    EXPECT_GE(atlas.families().rows(), 2U);
    EXPECT_GT(atlas.orbits().rows(), 20U);
  }
}

}  // namespace
}  // namespace cancelling_terms_test
