// Surveys by teams: of two on 5 ranks, of three on 4.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "run/teams.hpp"
#include "support/oscillator_chain.hpp"
#include "survey/atlas.hpp"

namespace teams_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

int team_size(const core::Communicator& comm) { return comm.size() == 5 ? 2 : comm.size() - 1; }

/// The cubic force with which the weakly coupled chain has the scales 1.
constexpr double in_scales = 0.25;

/// A chain of four particles, dimension 8: its four families, of a few orbits each. The scene's own system is not used.
/// By newton-krylov, which a team divides; collocation is done by each member alone.
scene::Scene chain_scene(int team, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"survey.team_size=" + std::to_string(team)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene::parse(
      "system: {name: harmonic_oscillator}\n"
      "starts: {fixed_points: {grid: [[0]]}, sweep: {period: [5.2, 6.3], step: 0.05}}\n"
      "continuation: {start: 0.3, corrector: newton-krylov}\n"
      "survey: {depth: 0}\n"
      "limits: {steps: 9}\n"
      "output: {flush_seconds: 0.05, flush_orbits: 3}\n",
      "chain", overrides);
}

survey::Summary run(const core::Communicator& comm, const scene::Scene& scene, const std::string& name,
                    const std::shared_ptr<const systems::System>& system) {
  const auto folder = test::fresh_folder(name + std::to_string(comm.size()), comm.get());
  return survey::run_survey(comm, scene, system, folder, {});
}

std::shared_ptr<const systems::System> chain() {
  return std::make_shared<const test::OscillatorChain>(4, 0.1, in_scales);
}

/// A chain whose field is spoilt where a particle is far out (unless a single state is asked for).
class SpoiltChain final : public test::OscillatorChain {
 public:
  explicit SpoiltChain(std::function<void(double& f)> spoil, double coupling = 0.1, double cubic = in_scales)
      : OscillatorChain(4, coupling, cubic), _spoil(std::move(spoil)), _far_out(0.4 / std::sqrt(cubic)) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    OscillatorChain::field(nodes, z, f);
    for (std::size_t n = 0; n < 4 * nodes && nodes > 1; ++n)
      if (std::abs(z[n]) > _far_out) _spoil(f[4 * nodes + n]);
  }

 private:
  std::function<void(double& f)> _spoil;
  double _far_out;
};

/// The last member of each team, or its leader.
bool is_last(const core::Communicator& comm) {
  return comm.rank() > 0 && (comm.rank() - 1) % team_size(comm) == team_size(comm) - 1;
}
bool is_leader(const core::Communicator& comm) { return comm.rank() > 0 && (comm.rank() - 1) % team_size(comm) == 0; }

TEST(Teams, AreRankZeroAndEqualPartsOfTheOthers) {
  const core::Communicator comm;
  survey::Teams teams(comm, team_size(comm));
  EXPECT_EQ(teams.team() == nullptr, comm.is_root());
  EXPECT_EQ(teams.follows(), !comm.is_root() && !is_leader(comm));
  if (teams.team() != nullptr) {
    EXPECT_EQ(teams.team()->size(), team_size(comm));
  }
  if (!teams.follows()) {
    EXPECT_EQ(teams.queue().size(), 1 + (comm.size() - 1) / team_size(comm));
  }

  survey::Teams none(comm, 1);
  EXPECT_EQ(none.team(), nullptr);
  EXPECT_EQ(none.queue().size(), comm.size());
}

TEST(Teams, SizesThatDoNotDivideTheWorkersAreRefusedByAll) {
  const core::Communicator comm;
  try {
    survey::Teams teams(comm, comm.size());
    FAIL() << "a team of all ranks was formed";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("survey.team_size = " + std::to_string(comm.size())));
    EXPECT_THAT(error.what(), HasSubstr("start " + std::to_string(comm.size() + 1) + " ranks"));
  }
  const auto refused = [&] { (void)run(comm, chain_scene(comm.size()), "refused", chain()); };
  EXPECT_THROW(refused(), core::InputError);
}

/// Steps that leave a row each, until a report says to stop; counts what it saw.
class Stepper final : public queue::Executor {
 public:
  explicit Stepper(archive::Records& rows) : _rows(rows) {}

  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override {
    steps = states = 0;
    most_rows = 0;
    for (bool go_on = true; go_on && steps < 50;) {
      ++steps;
      _rows.orbits.emplace_back();
      most_rows = std::max(most_rows, _rows.orbits.size());
      go_on = context.report({steps, 1, {0.5 * steps}}, [this] {
        ++states;
        return std::string("state");
      });
    }
    queue::TaskOutcome outcome;
    outcome.payload = task.payload + std::to_string(steps);
    return outcome;
  }

  int steps = 0;
  int states = 0;
  std::size_t most_rows = 0;

 private:
  archive::Records& _rows;
};

/// A run that asks for the state at the second report and stops the work at the fifth.
class StoppingRun final : public queue::TaskContext {
 public:
  bool report(const queue::Progress& progress, const queue::StateSource& state) override {
    if (progress.step == 2) {
      EXPECT_EQ(state(), "state");
    }
    return progress.step < 5;
  }
};

TEST(Teams, FollowTheLeadersAnswersToReports) {
  const core::Communicator comm;
  survey::Teams teams(comm, team_size(comm));
  if (teams.team() == nullptr) return;
  archive::Records rows;
  Stepper member(rows);
  if (teams.follows()) {
    const survey::Summary summary = survey::follow(*teams.team(), member, rows);
    EXPECT_EQ(summary.failures, 3U);
    EXPECT_TRUE(summary.stopped_early);
    EXPECT_TRUE(rows.orbits.empty());
    EXPECT_EQ(member.most_rows, 1U);
  } else {
    survey::TeamExecutor leader(teams.team(), member);
    StoppingRun run;
    for (const char* payload : {"first ", "second "}) {
      const queue::TaskOutcome outcome = leader.execute({"key", 0, "steps", payload}, run);
      EXPECT_EQ(outcome.payload, std::string(payload) + "5");
    }
    EXPECT_EQ(rows.orbits.size(), 10U);
    survey::Summary summary;
    summary.failures = 3;
    summary.stopped_early = true;
    survey::dismiss(teams.team(), summary);
  }
  EXPECT_EQ(member.steps, 5);
  EXPECT_EQ(member.states, 1);
}

TEST(Teams, AStateThatOneMemberCannotGiveFailsTheTaskForAll) {
  class Stateless final : public queue::Executor {
   public:
    explicit Stateless(bool fails) : _fails(fails) {}
    queue::TaskOutcome execute(const queue::Task&, queue::TaskContext& context) override {
      for (int step = 1; context.report({step, 0, {}}, [this] { return state(); });) ++step;
      return {};
    }

   private:
    [[nodiscard]] std::string state() const {
      if (_fails) throw std::runtime_error("no memory for the state");
      return "state";
    }
    bool _fails;
  };
  const core::Communicator comm;
  for (const bool leaders_fail : {true, false}) {
    survey::Teams teams(comm, team_size(comm));
    if (teams.team() == nullptr) continue;
    archive::Records rows;
    Stateless member(leaders_fail ? is_leader(comm) : is_last(comm));
    if (teams.follows()) {
      EXPECT_EQ(survey::follow(*teams.team(), member, rows).failures, 1U);
      continue;
    }
    survey::TeamExecutor leader(teams.team(), member);
    StoppingRun run;
    try {
      (void)leader.execute({"key", 0, "steps", "payload"}, run);
      ADD_FAILURE() << "a task came through without its state";
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), HasSubstr("no memory for the state"));
    }
    survey::Summary summary;
    summary.failures = 1;
    survey::dismiss(teams.team(), summary);
  }
}

TEST(Teams, SurveyAsOneRankDoes) {
  const core::Communicator comm;
  const survey::Summary alone = run(comm, chain_scene(1), "alone", chain());
  const survey::Summary shared = run(comm, chain_scene(team_size(comm)), "shared", chain());
  const survey::Summary again = run(comm, chain_scene(team_size(comm)), "again", chain());
  EXPECT_EQ(shared.failures, alone.failures);
  EXPECT_FALSE(shared.stopped_early);
  if (!comm.is_root()) return;
  EXPECT_EQ(shared.peak_memory_mib.size(), static_cast<std::size_t>(comm.size()));
  EXPECT_THAT(shared.peak_memory_mib, Each(::testing::Gt(1.0)));
  const test::Atlas one(alone.atlas);
  const test::Atlas team(shared.atlas);
  const test::Atlas repeated(again.atlas);
  ASSERT_EQ(one.families().rows(), 4U);
  ASSERT_EQ(team.orbits().rows(), one.orbits().rows());
  EXPECT_EQ(team.families().texts("end_reason"), one.families().texts("end_reason"));
  EXPECT_EQ(team.families().texts("isotropy"), one.families().texts("isotropy"));
  EXPECT_EQ(team.crossings().texts("kind"), one.crossings().texts("kind"));
  EXPECT_EQ(team.crossings().integers("kernel_dimension"), one.crossings().integers("kernel_dimension"));
  EXPECT_THAT(one.crossings().integers("kernel_dimension"), Contains(::testing::Gt(0)));
  EXPECT_EQ(team.orbits().integers("cutoff"), one.orbits().integers("cutoff"));
  for (std::size_t row = 0; row < one.orbits().rows(); ++row) {
    for (const char* column : {"period", "energy", "action", "arclength"})
      EXPECT_NEAR(team.orbits().reals(column)[row], one.orbits().reals(column)[row], 1e-9) << column;
    for (std::size_t pair = 3 * row; pair < 3 * row + 3; ++pair)
      EXPECT_NEAR(team.orbits().reals("stability")[pair], one.orbits().reals("stability")[pair], 1e-8);
    EXPECT_LT(team.orbits().reals("closure")[row], 1e-10);
    EXPECT_EQ(repeated.modes(row), team.modes(row));
    for (const char* column : {"period", "energy", "loss_rms", "closure", "stability_error"})
      EXPECT_EQ(repeated.orbits().reals(column)[row], team.orbits().reals(column)[row]) << column;
  }
}

TEST(Teams, HaveTheBytesOfOneRankWhereNothingIsDivided) {
  const core::Communicator comm;
  const std::vector<std::string> quick{"limits.period=6"};
  std::vector<std::string> by_teams = quick;
  by_teams.push_back("survey.team_size=" + std::to_string(team_size(comm)));
  const survey::Summary alone = test::run(comm, test::quick_scene(quick), "pendulum_alone");
  const survey::Summary shared = test::run(comm, test::quick_scene(by_teams), "pendulum_shared");
  EXPECT_EQ(shared.failures, 0U);
  if (!comm.is_root()) return;
  const test::Atlas one(alone.atlas);
  const test::Atlas team(shared.atlas);
  ASSERT_GT(one.orbits().rows(), 4U);
  ASSERT_EQ(team.orbits().rows(), one.orbits().rows());
  for (std::size_t row = 0; row < one.orbits().rows(); ++row) EXPECT_EQ(team.modes(row), one.modes(row));
}

/// Most tasks fail, all for the same reason, and nobody waits.
void expect_most_failed(const core::Communicator& comm, const survey::Summary& summary, const std::string& reason) {
  EXPECT_GE(summary.failures, 3U);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.families.size(), 4U);
  EXPECT_EQ(summary.failed_tasks.size(), summary.failures);
  EXPECT_THAT(summary.failed_tasks, Each(HasSubstr(reason)));
}

/// Coupled so strongly that no two oscillations have nearly one period: the sweep looks for no combinations of them,
/// far out.
constexpr double strong = 0.5;
scene::Scene strong_scene(const core::Communicator& comm) {
  return chain_scene(team_size(comm), {"starts.sweep.period=[3.5, 6.3]"});
}

/// Coupled so weakly that many small steps come before anything throws.
scene::Scene far_out_scene(const core::Communicator& comm) {
  return chain_scene(team_size(comm), {"continuation.start=0.05", "limits.steps=60"});
}

TEST(Teams, AFollowerThatThrowsFailsTheTaskForAll) {
  const core::Communicator comm;
  int calls = 0;
  const auto spoil = [&](double&) {
    if (is_last(comm) && ++calls % 997 == 0) throw std::runtime_error("no memory on this rank");
  };
  const auto summary =
      run(comm, strong_scene(comm), "follower_throws", std::make_shared<SpoiltChain>(spoil, strong, 1.0));
  const std::string who = fmt::format("member {} of a team of {} failed", team_size(comm) - 1, team_size(comm));
  expect_most_failed(comm, summary, who);
  expect_most_failed(comm, summary, "no memory on this rank");
}

TEST(Teams, ALeaderThatThrowsFailsTheTaskForAll) {
  const core::Communicator comm;
  int calls = 0;
  const auto spoil = [&](double&) {
    if (is_leader(comm) && ++calls % 1499 == 0) throw std::runtime_error("no memory on this rank");
  };
  const auto summary =
      run(comm, strong_scene(comm), "leader_throws", std::make_shared<SpoiltChain>(spoil, strong, 1.0));
  expect_most_failed(comm, summary, "no memory on this rank");
}

TEST(Teams, ALeaderThatThrowsBetweenTwoExchangesLeavesNobodyWaiting) {
  const core::Communicator comm;
  int calls = 0;
  const auto spoil = [&](double&) {
    if (is_leader(comm) && ++calls % 1499 == 0) throw std::runtime_error("no memory on this rank");
  };
  const auto summary = run(comm, far_out_scene(comm), "leader_throws_between", std::make_shared<SpoiltChain>(spoil));
  EXPECT_GE(summary.failures, 3U);
  if (!comm.is_root()) return;
  EXPECT_THAT(summary.failed_tasks, Each(HasSubstr("no memory on this rank")));
}

TEST(Teams, MembersWhoseNumbersDifferAreNoticed) {
  const core::Communicator comm;
  const auto spoil = [&](double& f) {
    if (is_last(comm)) f += 1e-12;
  };
  const auto summary = run(comm, chain_scene(team_size(comm)), "differ", std::make_shared<SpoiltChain>(spoil));
  expect_most_failed(comm, summary, "different numbers or different places");
}

TEST(Teams, AFieldThatIsNotFiniteIsTheTasksFailureAndNotTheTeams) {
  const core::Communicator comm;
  const auto spoil = [&](double& f) { f = std::nan(""); };
  const auto system = std::make_shared<SpoiltChain>(spoil);
  for (const std::string corrector : {"newton-krylov", "collocation"}) {
    const std::vector<std::string> changes{"limits.steps=100", "continuation.corrector=" + corrector};
    const auto alone = run(comm, chain_scene(1, changes), "nan_alone_" + corrector, system);
    const auto shared = run(comm, chain_scene(team_size(comm), changes), "nan_shared_" + corrector, system);
    EXPECT_EQ(shared.failures, 4U);
    EXPECT_EQ(shared.failures, alone.failures);
    if (!comm.is_root()) continue;
    EXPECT_THAT(shared.failed_tasks, Each(AllOf(HasSubstr("the vector field of"), HasSubstr("not finite"),
                                                HasSubstr("state ("), Not(HasSubstr("team")))));
    EXPECT_EQ(shared.orbits, alone.orbits);
  }
}

TEST(Teams, AreDismissedWithTheErrorOfTheSurvey) {
  class NowhereAtRest final : public test::OscillatorChain {
   public:
    NowhereAtRest() : OscillatorChain(4, 0.1, in_scales) {}
    void field(std::size_t nodes, const double* z, double* f) const override {
      OscillatorChain::field(nodes, z, f);
      for (std::size_t j = 0; j < nodes; ++j) f[j] = 1.0;
    }
  };
  const core::Communicator comm;
  const auto begin = [&] {
    (void)run(comm, chain_scene(team_size(comm)), "no_equilibrium", std::make_shared<NowhereAtRest>());
  };
  EXPECT_THROW(begin(), core::InputError);
}

TEST(Teams, StopWithTheirLeaders) {
  const core::Communicator comm;
  const auto summary =
      run(comm, chain_scene(team_size(comm), {"limits.time=1e-6", "limits.steps=200"}), "stopped", chain());
  EXPECT_TRUE(summary.stopped_early);
}

}  // namespace
}  // namespace teams_test
