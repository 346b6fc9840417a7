// Equilibria whose oscillations share a period, where what tells the families apart is weak.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "support/trefoil_well.hpp"
#include "survey/atlas.hpp"

namespace one_to_one_test {
namespace {

using namespace orbweaver;

// Two circular families, which the symmetry singles out, and two that a search must find: their periods differ by 1e-7.
// Of starts nearer to the equilibrium than it needs all stall, and the indices of the two that are missing cancel.
TEST(OneToOne, FamiliesThatTheSymmetryDoesNotSingleOutAreFoundFromAnyStart) {
  const core::Communicator comm;
  const std::map<std::string, double> well{{"B", 0.1125}, {"a", 0.2095}, {"b", -0.0322}, {"c", -0.3905}};
  for (const std::string start : {"0.0017", "0.0025", "0.0087", "0.0436"}) {
    SCOPED_TRACE(start);
    const scene::Scene scene = scene::load(
        ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml",
        {"starts.fixed_points.names={}", "starts.fixed_points.letters={}", "starts.sweep.period=auto",
         "starts.fixed_points.grid=[[0], [0], [0], [0]]", "survey.depth=0", "limits.energy=[-.inf, 0.02]",
         "limits.period=10", "continuation.start=" + start});
    const survey::Summary summary =
        survey::run_survey(comm, scene, test::trefoil_well(well), test::fresh_folder("one_to_one", comm.get()), {});
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    EXPECT_EQ(test::Atlas(summary.atlas).families().rows(), 4U);
  }
}

}  // namespace
}  // namespace one_to_one_test
