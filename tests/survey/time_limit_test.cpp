#include "run/time_limit.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <thread>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/queue/stop.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/scenes.hpp"

namespace time_limit_test {
namespace {

using namespace orbweaver;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST(TimeLimit, AsksForAStopWhenItsTimeIsOverAndTakesItBackInTheEnd) {
  queue::clear_stop();
  {
    survey::TimeLimit limit(0.5);
    EXPECT_FALSE(limit.reached());
    EXPECT_FALSE(queue::stop_requested());
    for (int n = 0; n < 1000 && !limit.reached(); ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(limit.reached());
    EXPECT_TRUE(queue::stop_requested());
    queue::RunSummary run;
    run.stopped = 2;
    run.waiting = 7;
    EXPECT_EQ(limit.remark(run), "stopped after limits.time = 0.5 s: tasks cut short: 2, not begun: 5");
  }
  EXPECT_FALSE(queue::stop_requested());
}

TEST(TimeLimit, LeavesTheStopOfASignalAlone) {
  queue::request_stop();
  {
    survey::TimeLimit limit(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    EXPECT_FALSE(limit.reached());
  }
  EXPECT_TRUE(queue::stop_requested());
  queue::clear_stop();
}

// Steps so small that the families would take minutes.
TEST(TimeLimit, EndsASurveyWithAWholeArchive) {
  const core::Communicator comm;
  survey::Summary summary;
  std::size_t families = 0;
  for (double seconds = 2.0; families == 0 && seconds < 100.0; seconds *= 3) {
    const scene::Scene scene = test::quick_scene(
        {"continuation.step=0.0005deg", "limits.steps=100000000", "limits.time=" + std::to_string(seconds)});
    const auto folder = test::fresh_folder("stopped" + std::to_string(comm.size()), comm.get());
    const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
    summary = survey::run_survey(comm, scene, system, folder, {});
    EXPECT_TRUE(summary.stopped_early);
    EXPECT_EQ(summary.failures, 0U);
    families = summary.families.size();  // none if the sweeps alone took longer
    MPI_Bcast(&families, sizeof families, MPI_BYTE, 0, comm.get());
  }
  EXPECT_FALSE(queue::stop_requested());
  if (!comm.is_root()) return;
  EXPECT_THAT(summary.remarks, Contains(HasSubstr("stopped after limits.time")));
  ASSERT_FALSE(summary.families.empty());
  const archive::Archive atlas(summary.atlas);
  EXPECT_EQ(atlas.orbits().rows(), static_cast<std::size_t>(summary.orbits));
  EXPECT_GT(atlas.orbits().rows(), 0U);
  for (const std::string& reason : atlas.families().texts("end_reason")) EXPECT_THAT(reason, HasSubstr("stopped ("));
}

}  // namespace
}  // namespace time_limit_test
