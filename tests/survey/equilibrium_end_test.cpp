#include "tasks/equilibrium_end.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/scenes.hpp"
#include "tasks/executor.hpp"

namespace equilibrium_end_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A small loop around (th1, th2).
loop::Loop around(double th1, double th2, double size) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{th1, th2, 0.0, 0.0}, 5.0, 4);
  loop.cosine(1, 0) = size;
  loop.sine(1, 3) = size;
  return loop;
}

TEST(EquilibriumEnd, IsTheSurveysThatNewtonsMethodReaches) {
  const auto system = systems::make_system("double_pendulum");
  const scene::Scene scene = test::quick_scene({});
  const double pi = std::numbers::pi;
  const EquilibriumEnd end = equilibrium_end(scene, *system, around(-pi + 1e-4, 2.0 * pi, 1e-3));
  EXPECT_EQ(end.index, 2);
  EXPECT_THAT(end.text, StartsWith("Equilibrium 3, th1 = 180 deg, th2 = 0 deg"));
}

TEST(EquilibriumEnd, AnotherOneIsSaidByItsPlace) {
  const auto system = systems::make_system("double_pendulum");
  const scene::Scene scene = test::quick_scene(
      {"starts.fixed_points.grid=[[0],[0]]", "starts.fixed_points.names={}", "starts.fixed_points.letters={}"});
  const EquilibriumEnd end = equilibrium_end(scene, *system, around(0.0, std::numbers::pi, 1e-3));
  EXPECT_EQ(end.index, -1);
  EXPECT_THAT(end.text, AllOf(StartsWith("th1 = 0 deg, th2 = 180 deg"), HasSubstr("does not lead to")));
}

TEST(EquilibriumEnd, NoneIsNear) {
  const auto system = systems::make_system("double_pendulum");
  const EquilibriumEnd end = equilibrium_end(test::quick_scene({}), *system, around(0.3, 0.0, 1e-3));
  EXPECT_EQ(end.index, -1);
  EXPECT_THAT(end.text, StartsWith("no equilibrium found near th1 = 17.1887 deg"));
}

// At rho = 20 the equilibria of Lorenz's equations are elsewhere than at 24: (s, s, rho - 1), s^2 = 8/3 (rho - 1).
TEST(EquilibriumEnd, IsLookedForWithTheParameterOfTheLastOrbit) {
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/lorenz.yaml", {"system.parameters.rho=20"});
  const auto system = scene::bound_system(scene.system);
  const double s = std::sqrt(8.0 / 3.0 * 23.0);
  loop::Loop last = loop::constant_loop(std::vector<double>{s, s, 23.0}, 0.65, 4);
  last.parameters = {24.0 / system->parameter_scale("rho")};
  for (std::size_t i = 0; i < 3; ++i) last.modes[i] /= system->scales().coordinate(i);
  last.cosine(1, 0) = 1e-3;
  const EquilibriumEnd end = equilibrium_end(scene, *system, last);
  EXPECT_EQ(end.index, -1);
  EXPECT_THAT(end.text, AllOf(StartsWith("x = 7.83156, y = 7.83156, z = 23"), HasSubstr("at rho = 24")));
}

struct Context : queue::TaskContext {
  bool report(const queue::Progress&, const queue::StateSource&) override { return true; }
};

// The branch of an orbit towards smaller amplitudes.
TEST(EquilibriumEnd, StandsInTheEndOfABranch) {
  const scene::Scene scene = test::quick_scene({"limits.period=8.5"});
  const auto system = systems::make_system("double_pendulum");
  archive::Records rows;
  Executor executor(scene, system, rows);
  Context context;
  const auto swept = executor.execute(task_of(SweepWork{0, {0.0, 0.0, 0.0, 0.0}}), context);
  const FoundMode mode = unpack_sweep_outcome(swept.payload).modes.front();
  BranchWork work;
  work.key = work.name = work.lineage.family = "0000.0000";
  work.direction = mode.direction;
  work.isotropy = mode.isotropy;
  work.base = loop::constant_loop(std::vector<double>(4, 0.0), mode.period, mode.cutoff);
  (void)executor.execute(task_of(work), context);

  const archive::OrbitRecord upper = rows.orbits.back();
  const archive::OrbitRecord& lower = rows.orbits[rows.orbits.size() - 2];
  const auto loop_of = [](const archive::OrbitRecord& row, int cutoff) {
    loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), row.period, row.cutoff);
    loop.modes = row.modes;
    loop.time_map = loop::time_map_of(row.time_map);
    return loop::with_time_map(loop, {}, cutoff);
  };
  const int cutoff = 2 * upper.cutoff;
  work.base = loop_of(upper, cutoff);
  work.direction = {loop_of(lower, cutoff).modes, {}};
  for (std::size_t n = 0; n < work.direction.modes.size(); ++n) work.direction.modes[n] -= work.base.modes[n];
  const BranchOutcome outcome = unpack_branch_outcome(executor.execute(task_of(work), context).payload);
  EXPECT_EQ(outcome.end.reason, continuation::EndReason::fixed_point) << outcome.end.text();
  EXPECT_EQ(outcome.equilibrium, 0);
  EXPECT_THAT(outcome.end.text(), AllOf(StartsWith("arrived at a fixed point (Equilibrium 1, th1 = 0 deg, th2 = 0 deg"),
                                        HasSubstr("; T = 8.2")));
}

}  // namespace
}  // namespace equilibrium_end_test
