#include "state/resume.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"
#include "tasks/payload/work.hpp"

namespace resume_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  return (std::ostringstream() << std::ifstream(path, std::ios::binary).rdbuf()).str();
}

/// A folder with two checkpoints, each with a journal; the newer one can be told by its failures.
class TwoCheckpoints : public ::testing::Test {
 protected:
  void SetUp() override {
    write(1, "");
    write(2, "");
  }

  /// `inner`: bytes that take the place of the branch's outcome.
  void write(std::size_t number, const std::string& inner) {
    BranchWork work;
    work.key = work.lineage.family = "0000.0000";
    BranchOutcome end;
    end.key = work.key;
    EndedTask entry{task_of(work), {}, true};
    entry.outcome.payload = inner.empty() ? pack(end) : inner;
    Checkpoint checkpoint;
    checkpoint.failures = number;
    checkpoint.journals = {write_journal(folder, number, {entry})};
    checkpoint.unfinished = {task_of(work)};
    write_checkpoint(folder, checkpoint);
  }

  [[nodiscard]] std::string refusal() const {
    try {
      (void)find_checkpoint(comm, folder);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  /// Goes on from the previous one, and writes again after that.
  void expect_previous() {
    const Found found = find_checkpoint(comm, folder);
    ASSERT_TRUE(found.found);
    EXPECT_EQ(found.checkpoint.failures, 1U);
    EXPECT_EQ(read_checkpoint(checkpoint_path(folder)).failures, 1U);
    write(3, "");
    write(4, "");
    EXPECT_EQ(read_checkpoint(checkpoint_path(folder)).failures, 4U);
    EXPECT_EQ(read_checkpoint(previous_checkpoint_path(folder)).failures, 3U);
  }

  core::Communicator comm;
  std::filesystem::path folder = test::fresh_folder("two");
};

TEST_F(TwoCheckpoints, TheNewerOneIsTaken) { EXPECT_EQ(find_checkpoint(comm, folder).checkpoint.failures, 2U); }

TEST_F(TwoCheckpoints, ALinkToItselfIsPassedOver) {
  std::filesystem::remove(checkpoint_path(folder));
  std::filesystem::create_symlink("checkpoint", checkpoint_path(folder));
  expect_previous();
}

TEST_F(TwoCheckpoints, AFolderIsPassedOverAndKept) {
  std::filesystem::remove(checkpoint_path(folder));
  std::filesystem::create_directory(checkpoint_path(folder));
  std::ofstream(checkpoint_path(folder) / "mine") << "text";
  expect_previous();
  EXPECT_TRUE(std::filesystem::exists(folder / "checkpoint.folder" / "mine"));
}

TEST_F(TwoCheckpoints, AFolderInPlaceOfThePreviousOneStopsNoFlush) {
  std::filesystem::remove(previous_checkpoint_path(folder));
  std::filesystem::create_directory(previous_checkpoint_path(folder));
  EXPECT_EQ(find_checkpoint(comm, folder).checkpoint.failures, 2U);
  write(3, "");
  EXPECT_EQ(read_checkpoint(previous_checkpoint_path(folder)).failures, 2U);
}

TEST_F(TwoCheckpoints, AJournalWhoseOutcomesCannotBeUnpackedIsPassedOver) {
  std::filesystem::remove(checkpoint_path(folder));
  std::filesystem::rename(previous_checkpoint_path(folder), checkpoint_path(folder));
  write(2, "no outcome");
  expect_previous();
}

TEST_F(TwoCheckpoints, WhereNeitherCanBeUsedItIsSaidWhatCanBeDone) {
  write(2, "no outcome");
  std::ofstream(previous_checkpoint_path(folder)) << "torn";
  const std::string before = bytes_of(checkpoint_path(folder));
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("journal-000002: a branch outcome"), HasSubstr("checkpoint.previous: it does not begin"),
                    HasSubstr("nothing was changed"), HasSubstr("from a copy"), HasSubstr("can still be read")));
  EXPECT_EQ(bytes_of(checkpoint_path(folder)), before);
}

TEST_F(TwoCheckpoints, APreviousOneOfANewerVersionIsNotFallenBackTo) {
  std::string newer = bytes_of(previous_checkpoint_path(folder));
  newer[8] = 99;  // the version
  std::ofstream(previous_checkpoint_path(folder), std::ios::binary) << newer;
  std::ofstream(checkpoint_path(folder)) << "torn";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("checkpoint.previous: its version is 99"), HasSubstr("use the newer")));
  EXPECT_EQ(bytes_of(previous_checkpoint_path(folder)), newer);
  EXPECT_TRUE(std::filesystem::exists(folder / "journal-000001"));
}

// Its segments and journals are not this Orbweaver's to remove.
TEST_F(TwoCheckpoints, BesideOneOfANewerVersionNothingIsRemoved) {
  std::string newer = bytes_of(previous_checkpoint_path(folder));
  newer[8] = 99;
  std::ofstream(previous_checkpoint_path(folder), std::ios::binary) << newer;
  EXPECT_THAT(refusal(), HasSubstr("checkpoint.previous: its version is 99"));
  EXPECT_TRUE(std::filesystem::exists(folder / "journal-000001"));
}

}  // namespace
}  // namespace resume_test
