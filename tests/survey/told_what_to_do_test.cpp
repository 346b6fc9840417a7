// What a survey that cannot begin says: what is so, and what to do.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "orbweaver/survey/tree/undeclared.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/driven_oscillator.hpp"
#include "survey/atlas.hpp"

namespace told_what_to_do_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::HasSubstr;

class ForgetfulOscillator : public test::DrivenOscillator {
 public:
  static systems::Structure structure(const systems::Bound& bound) {
    systems::Structure structure = test::DrivenOscillator::structure(bound);
    structure.driven = false;
    return structure;
  }
};

TEST(ToldWhatToDo, WhereADriveIsNotDeclared) {
  const auto system = systems::recorded<ForgetfulOscillator>(
      systems::bound_to(test::DrivenOscillator::info(), {{"d", 0.1}, {"s", 1.0}, {"c", 0.0}, {"F", 0.3}, {"w", 0.6}},
                        {}, {.free = {"w"}}));
  scene::Scene scene;
  scene.fixed_points.grid = {{0.0}, {0.0}};
  try {
    static_cast<void>(survey::expected_starts(scene, *system));
    FAIL() << "a phase never rests";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("phi changes at the same rate everywhere"));
    EXPECT_THAT(error.what(), HasSubstr("structure.driven = true"));
  }
}

// Without its cubic term a linear oscillator, all of whose orbits close; with it a cycle of its own.
TEST(ToldWhatToDo, WhereNeighboursCloseToo) {
  constexpr double tolerance = 1e-10;
  const auto linear = systems::make_system("van_der_pol", {{"mu", 0.0}});
  EXPECT_EQ(survey::undeclared_directions(*linear, std::vector{1.0, 0.0}, 2.0 * M_PI, tolerance), 1);
  const auto cycle = systems::make_system("van_der_pol", {{"mu", 1.0}});
  EXPECT_EQ(survey::undeclared_directions(*cycle, std::vector{2.00861986087484313650940188, 0.0},
                                          6.6632868593231301896996820305, tolerance),
            0);
  const auto conservative = systems::make_system("duffing", {{"alpha", 0.0}, {"beta", 1.0}});
  EXPECT_EQ(survey::undeclared_directions(*conservative, std::vector{1.0, 0.0}, 7.4162987092054876737, tolerance), 0);
}

// x'' = -x^3: nothing oscillates to first order.
TEST(ToldWhatToDo, WhereOscillationsHaveNoPeriodAtRest) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml",
                  {"system={name: duffing, parameters: {alpha: 0, beta: 1}}",
                   "starts={fixed_points: {grid: [[0], [0]]}}", "continuation={}", "limits={energy: [0, 1]}"});
  const survey::Summary summary = test::run(comm, scene, "cubic");
  EXPECT_EQ(summary.failures, 1U);
  EXPECT_THAT(summary.remarks, Contains(HasSubstr("has no period at rest; give an orbit of it with starts.states")));
}

}  // namespace
}  // namespace told_what_to_do_test
