#include "state/branch_state.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/scenes.hpp"
#include "tasks/executor.hpp"

namespace branch_state_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using namespace orbweaver::test;

/// Breaks work off after every `each` reports, and keeps the state that it gave then.
class Breaks : public queue::TaskContext {
 public:
  explicit Breaks(int each) : _each(each) {}
  bool report(const queue::Progress&, const queue::StateSource& source) override {
    if (_each == 0 || ++_reports % _each != 0) return true;
    state = source();
    return false;
  }
  std::string state;

 private:
  int _each;
  int _reports = 0;
};

/// All numbers of a row, with all their bits.
std::string text_of(const archive::OrbitRecord& r) {
  const auto bits = [](const std::vector<double>& values) { return fmt::format("{:a}", fmt::join(values, " ")); };
  return fmt::format(
      "{} {} | {} | {} | {} | {} | {} | {} | {} | {}", r.family_key, r.step,
      bits({r.arclength, r.period, r.energy, r.action, r.loss_rms, r.off_branch_eigenvalue, r.stability_error,
            r.log_volume, r.closure, r.single_shot, r.energy_drift, r.taylor_closure, r.recurrence, r.tail}),
      r.cutoff, bits(r.stability), bits(r.fundamental_stability), bits(r.state), bits(r.modes), bits(r.time_map),
      bits(r.winding));
}

struct Result {
  std::vector<std::string> rows;
  queue::TaskOutcome outcome;
  int breaks = 0;
};

class BranchStates : public ::testing::Test {
 protected:
  void use(const scene::Scene& of) {
    scene = of;
    system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  }

  /// Does a task in pieces: after each break another executor goes on.
  Result done(queue::Task task, int each) {
    Result result;
    while (true) {
      archive::Records rows;
      Executor executor(scene, system, rows);
      Breaks breaks(each);
      result.outcome = executor.execute(task, breaks);
      for (const archive::OrbitRecord& row : rows.orbits) result.rows.push_back(text_of(row));
      if (breaks.state.empty()) return result;
      task.state = breaks.state;
      ++result.breaks;
    }
  }

  void expect_same_in_pieces(const queue::Task& task) {
    const Result whole = done(task, 0);
    for (const int each : {1, 3}) {
      const Result pieces = done(task, each);
      EXPECT_GE(pieces.breaks, each == 1 ? 10 : 3);
      EXPECT_EQ(pieces.rows, whole.rows) << task.key << " in pieces of " << each;
      EXPECT_TRUE(pieces.outcome.children == whole.outcome.children);
      EXPECT_TRUE(pieces.outcome.payload == whole.outcome.payload);
      EXPECT_EQ(pieces.outcome.failed, whole.outcome.failed);
    }
  }

  /// The tasks that the scene's base families, their crossings and starts make, by key.
  std::map<std::string, queue::Task> branches_of_first_base(const std::string& kind) {
    std::map<std::string, queue::Task> found;
    const queue::TaskOutcome swept = done(task_of(SweepWork{0, {0.0, 0.0, 0.0, 0.0}}), 0).outcome;
    const FoundMode mode = unpack_sweep_outcome(swept.payload).modes.front();
    BranchWork base;
    base.key = base.name = base.lineage.family = "0000.0000";
    base.direction = mode.direction;
    base.isotropy = mode.isotropy;
    base.base = loop::constant_loop(std::vector<double>(4, 0.0), mode.period, mode.cutoff);
    std::vector<queue::Task> remaining{task_of(base)};
    while (!remaining.empty()) {
      const queue::Task task = remaining.back();
      remaining.pop_back();
      if (kind_of(task) == TaskKind::branch) found[task.key] = task;
      if (kind_of(task) == TaskKind::branch && task.key != "0000.0000") continue;
      if (kind_of(task) == TaskKind::locate && task.key.find(kind) == std::string::npos) continue;
      for (const queue::Task& child : done(task, 0).outcome.children) remaining.push_back(child);
    }
    return found;
  }

  scene::Scene scene;
  std::shared_ptr<const systems::System> system;
};

TEST_F(BranchStates, ASymmetricFamilyAndAFamilyBornAtIt) {
  use(quick_scene({"limits.period=18", "survey.depth=1", "survey.subharmonics=2", "events.periods=[9, 17.5]"}));
  const auto branches = branches_of_first_base("q4");
  ASSERT_GE(branches.size(), 2u);
  for (const auto& [key, task] : branches) expect_same_in_pieces(task);
}

TEST_F(BranchStates, AFamilyWithoutReversor) {
  use(quick_scene({"limits.period=16", "survey.depth=1", "survey.subharmonics=2"}));
  const auto branches = branches_of_first_base("q1");
  ASSERT_GE(branches.size(), 2u);
  for (const auto& [key, task] : branches)
    if (key != "0000.0000") expect_same_in_pieces(task);
}

TEST_F(BranchStates, ByNewtonOnWholeLoops) {
  use(quick_scene({"limits.period=10.5", "survey.depth=0", "continuation.corrector=newton-krylov"}));
  expect_same_in_pieces(branches_of_first_base("none").at("0000.0000"));
}

/// What a limit cut off goes on under a wider one as if it had not been there.
TEST_F(BranchStates, ABranchAtALimitGoesOn) {
  for (const char* limit : {"limits.period=9.8", "limits.energy=[-3, -1.3]", "limits.steps=10"}) {
    use(quick_scene({limit, "survey.subharmonics=2"}));
    const queue::Task task = branches_of_first_base("none").at("0000.0000");
    const Result narrow = done(task, 0);
    const BranchOutcome end = unpack_branch_outcome(narrow.outcome.payload);
    ASSERT_NE(end.limited_by, 0) << end.end.text();
    const BranchState state = unpack_branch_state(end.before_limit);
    std::vector<std::string> rows(narrow.rows.begin(), narrow.rows.begin() + state.outcome.orbits);
    EXPECT_GE(rows.size(), 5u);

    use(quick_scene({"limits.period=12", "survey.subharmonics=2"}));
    const Result wide = done(task, 0);
    queue::Task rest = task;
    rest.state = end.before_limit;
    const Result more = done(rest, 0);
    EXPECT_GE(more.rows.size(), 3u);
    rows.insert(rows.end(), more.rows.begin(), more.rows.end());
    EXPECT_EQ(rows, wide.rows) << limit;
    EXPECT_TRUE(more.outcome.payload == wide.outcome.payload) << limit;
    // The tasks found before the limit are the narrow survey's.
    std::vector<queue::Task> children = narrow.outcome.children;
    ASSERT_LE(more.outcome.children.size(), wide.outcome.children.size());
    children.resize(wide.outcome.children.size() - more.outcome.children.size());
    children.insert(children.end(), more.outcome.children.begin(), more.outcome.children.end());
    EXPECT_TRUE(children == wide.outcome.children) << limit;
  }
}

}  // namespace
}  // namespace branch_state_test
