#include "state/payload_store.hpp"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/file/sealed_file.hpp"
#include "orbweaver/core/error.hpp"
#include "state/branch_state.hpp"
#include "state/resume.hpp"
#include "tasks/payload/work.hpp"

namespace payload_store_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

BranchWork branch_work(const std::string& key) {
  BranchWork work;
  work.key = work.lineage.family = key;
  work.name = "In-Phase>2@10.5/0";
  work.base.dimension = 4;
  work.base.cutoff = 100;
  work.base.period = 3.0;
  work.base.modes.assign(4 * 201, 0.5);
  work.base.winding.assign(4, 0.0);
  work.direction.modes.assign(4 * 201, 0.25);
  return work;
}

/// The payload need not be that of a location to be stored.
queue::Task location(const std::string& key, char letter) {
  return {"locate " + key, 2, name_of(TaskKind::locate), std::string(10'000, letter)};
}

std::string fault_of(PayloadStore& store, const queue::Task& task) {
  try {
    (void)store.whole(task);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

class Stored : public ::testing::Test {
 protected:
  void SetUp() override { store.open(comm); }

  queue::Task kept(queue::Task task) {
    store.keep(task);
    EXPECT_TRUE(is_stored(task.payload));
    return task;
  }

  core::Communicator comm;
  std::filesystem::path folder = test::fresh_folder("payloads");
  PayloadStore store{folder};
};

TEST_F(Stored, LargePayloadsComeBackFromTheFileAndSmallOnesStayInTheTask) {
  queue::Task small = location("a", 'a');
  small.payload.resize(least_stored - 1);
  const std::string before = small.payload;
  store.keep(small);
  EXPECT_EQ(small.payload, before);
  EXPECT_THAT(files_in(folder), ElementsAre());
  std::vector<queue::Task> tasks;
  for (const char letter : {'a', 'b', 'c'}) tasks.push_back(kept(location(std::string(1, letter), letter)));
  EXPECT_THAT(files_in(folder), ElementsAre("payloads-000001"));
  const queue::Task once = tasks[0];
  store.keep(tasks[0]);
  EXPECT_EQ(tasks[0], once) << "it is stored already";
  store.sync();
  for (const queue::Task& task : tasks) {
    EXPECT_LT(task.payload.size(), 150U);
    EXPECT_TRUE(store.whole(task) == std::string(10'000, task.key.back()));
  }
  EXPECT_EQ(std::filesystem::file_size(folder / "payloads-000001"), 30'000U);
  EXPECT_EQ(store.whole(small), before);
}

/// Rank 0 reads no loops, and gets none.
TEST_F(Stored, OfBranchesAndStartsTheTreeIsToldWhatItReads) {
  const BranchWork work = branch_work("0000.0001");
  for (const queue::Task& whole : {task_of(work), task_of(StartWork{work})}) {
    const queue::Task task = kept(whole);
    EXPECT_LT(task.payload.size(), 600U);
    const BranchWork told = told_branch(task);
    EXPECT_EQ(told.key, work.key);
    EXPECT_EQ(told.name, work.name);
    EXPECT_EQ(told.lineage.family, work.lineage.family);
    EXPECT_EQ(told_branch(whole).base.modes, work.base.modes) << "one that is not stored";
    EXPECT_TRUE(store.whole(task) == whole.payload);
  }
}

TEST_F(Stored, ADamagedOneIsNamedAndNoFlushSucceedsAfterIt) {
  const queue::Task first = kept(location("a", 'a'));
  const queue::Task second = kept(location("b", 'b'));
  store.sync();
  std::fstream(folder / "payloads-000001", std::ios::binary | std::ios::in | std::ios::out).seekp(10'005).put('x');
  EXPECT_EQ(fault_of(store, first), "");
  store.sync();
  EXPECT_THAT(fault_of(store, second), AllOf(HasSubstr("payloads-000001, 10000 bytes from 10000 on"),
                                             HasSubstr("checksum is wrong")));
  try {
    store.sync();
    FAIL() << "a checkpoint would count on what was made of it";
  } catch (const core::EnvironmentError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("task \"locate b\""), HasSubstr("payloads-000001")));
  }
}

TEST_F(Stored, WhatCannotBeWrittenStaysInTheTask) {
  std::filesystem::create_directory(folder / "payloads-000001");
  queue::Task task = location("a", 'a');
  store.keep(task);
  EXPECT_EQ(task, location("a", 'a'));
  store.sync();
}

TEST_F(Stored, FilesOfEarlierRunsAreNotWrittenTo) {
  const queue::Task earlier = kept(location("a", 'a'));
  std::ofstream(folder / "payloads-000041") << "another rank's";
  PayloadStore next(folder);
  next.open(comm);
  queue::Task later = location("b", 'b');
  next.keep(later);
  EXPECT_TRUE(std::filesystem::exists(folder / "payloads-000042"));
  EXPECT_TRUE(next.whole(earlier) == std::string(10'000, 'a'));
  EXPECT_TRUE(store.whole(later) == std::string(10'000, 'b'));
}

/// A survey of which each list of tasks has a payload in a file of its own.
class StoredSurvey : public ::testing::Test {
 protected:
  void SetUp() override {
    tasks.clear();
    for (int n = 1; n <= 6; ++n) {
      PayloadStore store(folder);
      store.open(comm);
      LocateWork work;
      work.key = "0000.0001/00" + std::to_string(n) + ".q4.j1";
      work.name = std::string(10'000, 'x');
      queue::Task task = n == 3 ? task_of(branch_work("0000.0001")) : task_of(work);
      store.keep(task);
      tasks.push_back(task);
    }
    write_checkpoint(folder, with(tasks[5]));  // becomes the previous one
    checkpoint = with(tasks[0]);
    checkpoint.left_out = {tasks[1]};
    EndedTask ended{tasks[2], {}, true};
    BranchOutcome end;
    end.key = "0000.0001";
    end.before_limit = before_limit();
    state_file = unpack_stored_work(end.before_limit).file;
    ended.outcome.payload = pack(end);
    checkpoint.journals = {write_journal(folder, 1, {ended})};
    BranchState state;
    state.children = {tasks[3]};
    queue::Task running = task_of(branch_work("0000.0002"));
    running.state = pack(state);
    checkpoint.unfinished.push_back(running);
    write_checkpoint(folder, checkpoint);
  }

  /// In the last file.
  std::string before_limit() {
    BranchState state;
    state.last.loop = branch_work("0000.0001").base;
    std::string bytes = pack(state);
    PayloadStore store(folder);
    store.open(comm);
    store.keep(bytes);
    EXPECT_TRUE(is_stored(bytes));
    return bytes;
  }

  static Checkpoint with(const queue::Task& task) {
    Checkpoint checkpoint;
    checkpoint.unfinished = {task};
    return checkpoint;
  }

  void change(int file) {
    std::fstream(folder / payload_file(file), std::ios::binary | std::ios::in | std::ios::out).seekp(5'000).put('!');
  }

  core::Communicator comm;
  std::filesystem::path folder = test::fresh_folder("stored_survey");
  std::vector<queue::Task> tasks;
  int state_file = 0;
  Checkpoint checkpoint;
};

TEST_F(StoredSurvey, FilesAreRemovedThatNeitherCheckpointCountsOn) {
  EXPECT_TRUE(find_checkpoint(comm, folder).found);
  EXPECT_THAT(files_in(folder), UnorderedElementsAre("checkpoint", "checkpoint.previous", "journal-000001",
                                                     "payloads-000001", "payloads-000002", "payloads-000003",
                                                     "payloads-000004", "payloads-000006", "payloads-000007"));
}

TEST_F(StoredSurvey, WithADamagedPayloadTheCheckpointBeforeIsTaken) {
  for (const std::size_t file : {1, 2, 3, 4, 7}) {
    SCOPED_TRACE(file);
    SetUp();  // with other files
    change(file == 7 ? state_file : unpack_stored_work(tasks[file - 1].payload).file);
    testing::internal::CaptureStderr();
    const Found found = find_checkpoint(comm, folder);
    (void)testing::internal::GetCapturedStderr();
    ASSERT_TRUE(found.found);
    EXPECT_THAT(found.checkpoint.unfinished, ElementsAre(tasks.back()));
  }
}

TEST_F(StoredSurvey, WhereNeitherCanBeUsedTheDamagedFilesAreNamed) {
  change(4);
  std::filesystem::remove(folder / payload_file(6));
  const auto before = files_in(folder);
  try {
    (void)find_checkpoint(comm, folder);
    FAIL() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("payloads-000004"), HasSubstr("checksum is wrong"),
                                    HasSubstr("payloads-000006"), HasSubstr("not there"),
                                    HasSubstr("nothing was changed")));
  }
  EXPECT_EQ(files_in(folder), before);
}

/// What the version before wrote has no model's text.
TEST_F(StoredSurvey, ACheckpointOfTheVersionBeforeIsRefused) {
  const auto path = checkpoint_path(folder);
  const std::string content = archive::read_sealed(path, {"ORBWCKP\x1a", 6});
  archive::write_sealed(path, {"ORBWCKP\x1a", 6}, content);
  EXPECT_EQ(read_checkpoint(path).unfinished, checkpoint.unfinished);
  archive::write_sealed(path, {"ORBWCKP\x1a", 5}, content);
  EXPECT_THROW((void)read_checkpoint(path), core::InputError);
}

}  // namespace
}  // namespace payload_store_test
