#include "orbweaver/survey/tree/undeclared.hpp"

#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/driven_oscillator.hpp"
#include "support/magnetic_well.hpp"
#include "survey/atlas.hpp"

namespace undeclared_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

// Nothing rests at every phase of a drive; the symmetry is about the origin.
TEST(UndeclaredFromStates, HasTheHalfTurnOfADrivenSystem) {
  const auto system = systems::recorded<test::DrivenOscillator>(
      systems::bound_to(test::DrivenOscillator::info(), {{"d", 0.1}, {"s", 1.0}, {"c", 0.0}, {"F", 0.3}, {"w", 0.6}},
                        {}, {.free = {"w"}}));
  EXPECT_THAT(survey::undeclared(*system, {}, {{0.4, 0.1, 0.0}}).symmetries,
              ElementsAre("the symmetry (x, v, phi) -> (-x, -v, phi + pi)"));
}

// What `check` tells, and the notes of the survey.
TEST(UndeclaredFromStates, IsToldByTheSurveyAsByItsCheck) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml",
                  {"starts={states: [{state: [0.1, 0, 0, 0], period: 6.28}]}", "limits.steps=1", "survey.depth=0"});
  const auto system = test::magnetic_well({{"b", 0.0}, {"k2", 3.0}, {"a2", 0.0}, {"a4", 0.0}});
  const std::vector<std::string> told = survey::expected_starts(scene, *system).undeclared.symmetries;
  EXPECT_THAT(told, ElementsAre("the reversor (x, y, px, py) -> (x, y, -px, -py)",
                                "the reversor (x, y, px, py) -> (x, -y, -px, py)"));
  const auto folder = test::fresh_folder("undeclared" + std::to_string(comm.size()), comm.get());
  const survey::Summary summary = survey::run_survey(comm, scene, system, folder, {});
  for (const std::string& symmetry : told) EXPECT_THAT(summary.remarks, Contains(HasSubstr(symmetry)));
}

}  // namespace
}  // namespace undeclared_test
