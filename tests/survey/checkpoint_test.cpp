#include "state/checkpoint.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"
#include "state/branch_state.hpp"
#include "state/checkpoint_keeper.hpp"
#include "state/reopen.hpp"
#include "survey/scenes.hpp"
#include "tasks/payload/work.hpp"

namespace checkpoint_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

queue::Task task(const std::string& key, TaskKind kind = TaskKind::sweep) {
  return {key, 3, name_of(kind), "payload of " + key};
}

queue::TaskOutcome outcome(const std::string& key, std::vector<queue::Task> children = {}) {
  queue::TaskOutcome done;
  done.key = key;
  done.payload = "result of " + key;
  done.children = std::move(children);
  return done;
}

// As programs wrote them that kept the words of a field as it threw them.
TEST(Checkpoint, AJournalsReasonsOfAnyBytesAreReadAsTheyCanBeShown) {
  const auto folder = test::fresh_folder("journal_bytes");
  EndedTask sweep{task("sweep.0000"), outcome("sweep.0000")};
  sweep.outcome.failed = true;
  sweep.outcome.reason = "Kr\xf6mmung";
  BranchOutcome followed;
  followed.end = {continuation::EndReason::failure, "Kr\xf6mmung"};
  EndedTask branch{task("0000.0000", TaskKind::branch), outcome("0000.0000")};
  branch.outcome.payload = pack(followed);
  const JournalFile file = write_journal(folder, 1, {sweep, branch});
  const std::vector<EndedTask> read = read_journal(folder, file);
  EXPECT_EQ(read[0].outcome.reason, R"(Kr\xf6mmung)");
  EXPECT_EQ(unpack_branch_outcome(read[1].outcome.payload).end.detail, R"(Kr\xf6mmung)");
}

TEST(Checkpoint, ComesBackWhole) {
  const auto folder = test::fresh_folder("checkpoint");
  Checkpoint written;
  written.orbweaver_version = "1.2.3";
  written.scene = "name: x\n";
  written.earlier_scenes = {"name: y\n"};
  written.stage = Stage::families;
  written.failures = 2;
  written.segments = {{"segment-000001.h5", 10, 20, 30, 40}};
  written.journals = {{"journal-000007", 5}};
  written.voided = {{"0000.0001", -3, 9, 1}};
  written.unfinished = {task("a")};
  written.unfinished[0].state = std::string("\0state", 6);
  written.left_out = {task("b")};
  write_checkpoint(folder, written);
  const Checkpoint read = read_checkpoint(checkpoint_path(folder));
  EXPECT_EQ(read.orbweaver_version, written.orbweaver_version);
  EXPECT_EQ(read.scene, written.scene);
  EXPECT_EQ(read.earlier_scenes, written.earlier_scenes);
  EXPECT_EQ(read.stage, written.stage);
  EXPECT_EQ(read.failures, 2U);
  ASSERT_EQ(read.segments.size(), 1U);
  EXPECT_EQ(read.segments[0].name, "segment-000001.h5");
  EXPECT_EQ(read.segments[0].fingerprint, 40U);
  ASSERT_EQ(read.voided.size(), 1U);
  EXPECT_EQ(read.voided[0].first_step, -3);
  EXPECT_EQ(read.unfinished, written.unfinished);
  EXPECT_EQ(read.left_out, written.left_out);
  EXPECT_EQ(next_journal(read), 8U);
}

/// A stop behind a flush writes no second time what may have 300 MB.
TEST(Checkpoint, WhatIsWrittenIsNotWrittenAgain) {
  const auto folder = test::fresh_folder("unchanged");
  Checkpoint checkpoint;
  CheckpointMark newest = write_checkpoint(folder, checkpoint);
  checkpoint.unfinished = {task("a")};
  newest = write_checkpoint(folder, checkpoint, newest);
  EXPECT_EQ(write_checkpoint(folder, checkpoint, newest), newest);
  EXPECT_THAT(read_checkpoint(previous_checkpoint_path(folder)).unfinished, IsEmpty()) << "of the first one";
  checkpoint.failures = 1;
  EXPECT_NE(write_checkpoint(folder, checkpoint, newest), newest);
  EXPECT_EQ(read_checkpoint(checkpoint_path(folder)).failures, 1U);
  EXPECT_EQ(read_checkpoint(previous_checkpoint_path(folder)).unfinished.size(), 1U);
  std::filesystem::remove(checkpoint_path(folder));
  newest = write_checkpoint(folder, checkpoint, newest);
  newest = write_checkpoint(folder, checkpoint, newest);
  EXPECT_EQ(read_checkpoint(checkpoint_path(folder)).failures, 1U) << "somebody has taken it away";
}

TEST(Checkpoint, AJournalWithOtherEntriesIsRefused) {
  const auto folder = test::fresh_folder("journal");
  const JournalFile file = write_journal(folder, 1, {{task("a"), outcome("a"), true}});
  ASSERT_EQ(read_journal(folder, file).size(), 1U);
  EXPECT_TRUE(read_journal(folder, file)[0].had_children);
  EXPECT_EQ(read_journal(folder, file)[0].task, task("a"));
  EXPECT_THROW((void)read_journal(folder, {file.name, 2}), core::InputError);
  EXPECT_THROW((void)read_journal(folder, {"journal-000002", 1}), core::InputError);
  EXPECT_THROW((void)read_checkpoint(folder / file.name), core::InputError) << "a journal is no checkpoint";
}

std::vector<std::string> keys_of(const std::vector<queue::Task>& tasks) {
  std::vector<std::string> keys;
  for (const queue::Task& t : tasks) keys.push_back(t.key);
  return keys;
}

/// What ends between the state taken and the file written belongs to the next checkpoint.
TEST(CheckpointKeeper, WritesTheStateThatWasTaken) {
  const auto folder = test::fresh_folder("keeper");
  CheckpointKeeper keeper(folder, Checkpoint{});
  queue::TaskQueue queue;
  for (const char* key : {"a", "b", "c"}) queue.add(task(key));
  (void)queue.start_next();
  (void)queue.start_next();
  (void)queue.finish("a");
  keeper.ended(task("a"), outcome("a", {task("child")}));
  queue.set_state("b", "half way");
  keeper.take(queue, {task("left")});
  (void)queue.finish("b");
  keeper.ended(task("b"), outcome("b"));
  keeper.commit({{"segment-000001.h5", 1, 2, 3, 4}});
  Checkpoint checkpoint = read_checkpoint(checkpoint_path(folder));
  EXPECT_THAT(keys_of(checkpoint.unfinished), ElementsAre("b", "c"));
  EXPECT_EQ(checkpoint.unfinished[0].state, "half way");
  EXPECT_THAT(keys_of(checkpoint.left_out), ElementsAre("left"));
  EXPECT_EQ(checkpoint.segments.size(), 1U);
  ASSERT_EQ(checkpoint.journals.size(), 1U);
  std::vector<EndedTask> ended = read_journal(folder, checkpoint.journals[0]);
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].task.key, "a");
  EXPECT_TRUE(ended[0].had_children);
  EXPECT_THAT(ended[0].outcome.children, IsEmpty());

  keeper.take(queue, {});
  keeper.commit({});
  checkpoint = read_checkpoint(checkpoint_path(folder));
  EXPECT_THAT(keys_of(checkpoint.unfinished), ElementsAre("c"));
  ASSERT_EQ(checkpoint.journals.size(), 2U);
  EXPECT_EQ(read_journal(folder, checkpoint.journals[1])[0].task.key, "b");
}

/// A branch that ended at the period limit in its 5th orbit with two events, what hangs on it, and one that did not.
class Reopened : public ::testing::Test {
 protected:
  Reopened() {
    BranchWork work;
    work.key = work.lineage.family = "0000.0000";
    BranchOutcome end;
    end.key = work.key;
    end.orbits = 5;
    end.limited_by = period_limited;
    branch = {task_of(work), {}, true};
    branch.outcome.payload = pack(end);
    work.key = work.lineage.family = "0000.0001";
    end.limited_by = 0;
    other = {task_of(work), {}, true};
    other.outcome.payload = pack(end);
    checkpoint.segments.resize(3);
  }

  EndedTask located(const std::string& key, int limited_by) {
    LocateWork work;
    work.key = key;
    LocateOutcome found;
    found.key = key;
    found.limited_by = limited_by;
    EndedTask entry{task_of(work), {}, false};
    entry.outcome.payload = pack(found);
    return entry;
  }

  /// A branch that ended at the period limit; before it, `orbits` orbits and `events` events.
  static EndedTask branch_with_state(const std::string& key, int side, int orbits, int events) {
    BranchWork work;
    work.key = key;
    work.lineage.family = key;
    work.lineage.side = side;
    BranchState state;
    state.outcome.orbits = orbits;
    state.events = events;
    BranchOutcome end;
    end.key = key;
    end.orbits = orbits + 2;
    end.limited_by = period_limited;
    end.before_limit = pack(state);
    EndedTask entry{task_of(work), {}, true};
    entry.outcome.payload = pack(end);
    return entry;
  }

  EndedTask started(const std::string& key, int limited_by) {
    EndedTask entry{task("start " + key, TaskKind::start), outcome("start " + key), true};
    entry.outcome.payload = pack(StartOutcome{limited_by});
    return entry;
  }

  EndedTask branch;
  EndedTask other;
  Checkpoint checkpoint;
};

TEST_F(Reopened, NothingWithoutWiderLimits) {
  Reopening reopening(0, checkpoint);
  EXPECT_TRUE(reopening.stays(branch));
  EXPECT_TRUE(reopening.stays(located("0000.0000/000.q4.j1", depth_limited)));
  reopening.finish();
  EXPECT_FALSE(reopening.any());
}

TEST_F(Reopened, ABranchWithAllThatHangsOnIt) {
  checkpoint.unfinished = {task("locate 0000.0000/001.q1.j0"), task("locate 0000.0001/000.q1.j0")};
  checkpoint.left_out = {task("0000.0000/000.q4.j1/0", TaskKind::start)};
  Reopening reopening(period_limited, checkpoint);
  EXPECT_FALSE(reopening.stays(branch));
  EXPECT_TRUE(reopening.stays(other));
  EXPECT_FALSE(reopening.stays(located("0000.0000/000.q4.j1", 0))) << "it hangs on the branch";
  EXPECT_TRUE(reopening.stays(located("0000.0001/000.q4.j1", depth_limited))) << "another limit";
  EXPECT_FALSE(reopening.stays(located("0000.0001/001.q4.j1", period_limited)));
  EXPECT_TRUE(reopening.stays(started("0000.0001/000.q4.j1/0", 0)));
  EXPECT_FALSE(reopening.stays({task("start 0000.0001/000.q4.j1/1", TaskKind::start), outcome("x"), false}));
  reopening.finish();
  EXPECT_TRUE(reopening.any());
  EXPECT_THAT(keys_of(checkpoint.unfinished), ElementsAre("locate 0000.0001/000.q1.j0", "0000.0000",
                                                          "locate 0000.0001/001.q4.j1", "start 0000.0001/000.q4.j1/1"));
  EXPECT_THAT(checkpoint.left_out, IsEmpty());
  ASSERT_EQ(checkpoint.voided.size(), 1U);
  EXPECT_EQ(checkpoint.voided[0].family_key, "0000.0000");
  EXPECT_EQ(checkpoint.voided[0].first_step, 0) << "without a state the branch begins again";
  EXPECT_EQ(checkpoint.voided[0].before_segment, 3);
}

TEST_F(Reopened, ABranchFromTheStateBeforeItsLimit) {
  for (const int side : {1, -1}) {
    SCOPED_TRACE(side);
    Checkpoint kept = checkpoint;
    const EndedTask entry = branch_with_state("0000.0002", side, 3, 1);
    Reopening reopening(period_limited, kept);
    EXPECT_FALSE(reopening.stays(entry));
    EXPECT_TRUE(reopening.stays(located("0000.0002/000.q4.j1", 0))) << "found before the state";
    EXPECT_FALSE(reopening.stays(located("0000.0002/001.q4.j1", 0)));
    reopening.finish();
    ASSERT_EQ(kept.unfinished.size(), 1U);
    EXPECT_EQ(kept.unfinished[0].payload, entry.task.payload);
    EXPECT_EQ(kept.unfinished[0].state, unpack_branch_outcome(entry.outcome.payload).before_limit);
    ASSERT_EQ(kept.voided.size(), 1U);
    const bool forwards = side > 0;
    EXPECT_EQ(kept.voided[0].first_step, forwards ? 3 : archive::VoidedRows{}.first_step);
    EXPECT_EQ(kept.voided[0].last_step, forwards ? archive::VoidedRows{}.last_step : -4);
  }
}

// Its children so far are no tasks yet, and go back with it.
TEST_F(Reopened, ABranchThatRunsFromTheStateBeforeALimitThatItCameBy) {
  const std::string key = "0000.0002";
  const EndedTask ended = branch_with_state(key, 1, 3, 1);
  BranchState now;
  now.outcome = unpack_branch_outcome(ended.outcome.payload);
  now.events = 2;
  now.children = {task("locate " + key + "/000.q4.j1", TaskKind::locate),
                  task("locate " + key + "/001.q4.j1", TaskKind::locate)};
  queue::Task running = ended.task;
  running.state = pack(now);
  for (const int widened : {period_limited, step_limited}) {
    Checkpoint kept = checkpoint;
    kept.unfinished = {running};
    Reopening reopening(widened, kept);
    reopening.finish();
    ASSERT_EQ(kept.unfinished.size(), 1U);
    if (widened == step_limited) {
      EXPECT_EQ(kept.unfinished[0], running) << "another limit";
      EXPECT_THAT(kept.voided, IsEmpty());
      continue;
    }
    const BranchState before = unpack_branch_state(kept.unfinished[0].state);
    EXPECT_EQ(before.outcome.orbits, 3);
    EXPECT_EQ(before.outcome.limited_by, 0);
    EXPECT_THAT(keys_of(before.children), ElementsAre("locate " + key + "/000.q4.j1"));
    ASSERT_EQ(kept.voided.size(), 1U);
    EXPECT_EQ(kept.voided[0].first_step, 3);
  }
}

TEST_F(Reopened, AStartWithTheBranchThatItMade) {
  const std::string key = "0000.0001/000.q4.j1/0";
  const auto branch_at = [](const std::string& at) {
    BranchWork work;
    work.key = work.lineage.family = at;
    BranchOutcome end;
    end.key = at;
    EndedTask entry{task_of(work), {}, true};
    entry.outcome.payload = pack(end);
    return entry;
  };
  const std::string born = key + "/000.q2.j1/0";
  const std::string waiting = key + "/001.q2.j1/0";
  checkpoint.unfinished = {branch_at(waiting).task};
  EndedTask start = started(key, energy_limited);
  start.task.state = "of the last try";
  Reopening reopening(energy_limited, checkpoint);
  EXPECT_FALSE(reopening.stays(start));
  EXPECT_FALSE(reopening.stays(branch_at(key)));
  EXPECT_FALSE(reopening.stays(located(key + "/000.q2.j1", 0)));
  EXPECT_FALSE(reopening.stays(branch_at(born)));
  EXPECT_TRUE(reopening.stays(branch_at("0000.0001/000.q4.j1/1")));
  reopening.finish();
  EXPECT_THAT(keys_of(checkpoint.unfinished), ElementsAre("start " + key));
  EXPECT_EQ(checkpoint.unfinished[0].state, "");
  std::vector<std::string> voided;
  for (const archive::VoidedRows& rows : checkpoint.voided) {
    voided.push_back(rows.family_key);
    EXPECT_EQ(rows.first_step, 0);
  }
  EXPECT_THAT(voided, ElementsAre(key, born, waiting));
}

TEST_F(Reopened, NoRowsAreVoidBeforeThereIsASegment) {
  checkpoint.segments.clear();
  Reopening reopening(period_limited, checkpoint);
  EXPECT_FALSE(reopening.stays(branch));
  reopening.finish();
  EXPECT_THAT(checkpoint.voided, IsEmpty());
}

TEST(WidenedLimits, AreKnownByTheirKeys) {
  const auto limits = [](const std::vector<std::string>& overrides) {
    return widened_limits(test::quick_scene({"limits.period=10", "limits.steps=10", "limits.energy=[-3,1]"}),
                          test::quick_scene(overrides));
  };
  EXPECT_EQ(limits({"limits.period=10", "limits.steps=10", "limits.energy=[-3,1]"}), 0);
  EXPECT_EQ(limits({"limits.period=12", "limits.steps=10", "limits.energy=[-3,1]"}), period_limited);
  EXPECT_EQ(limits({"limits.period=10", "limits.steps=11", "limits.energy=[-3,2]"}), step_limited | energy_limited);
  EXPECT_EQ(limits({"limits.period=10", "limits.steps=10", "limits.energy=[-3,1]", "survey.depth=1"}), depth_limited);
  const auto guarded = [](const std::string& guards) {
    return scene::parse("system: {name: pcr3bp}\nstarts: {}\n", "guards.yaml", {"limits.guards=" + guards});
  };
  EXPECT_EQ(widened_limits(guarded("{r2: 0.01}"), guarded("{r2: 0.005}")), guard_limited);
}

}  // namespace
}  // namespace checkpoint_test
