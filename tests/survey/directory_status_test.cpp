#include "orbweaver/survey/state/directory_status.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"

namespace directory_status_test {
namespace {

using namespace orbweaver;
using survey::DirectoryStatus;
using ::testing::AllOf;
using ::testing::HasSubstr;

// The scene that the sample atlas says it was made from.
scene::Scene sample_scene() {
  scene::Scene scene;
  scene.text = test::sample_header().scene;
  return scene;
}

std::filesystem::path folder_with_atlas(const std::string& name, const std::string& an_end = "period limit (T = 30)") {
  const std::filesystem::path folder = test::fresh_folder(name);
  const auto header = test::sample_header();
  archive::Records records = test::sample_records(header);
  records.families[2].end_reason = an_end;
  std::filesystem::rename(test::write_sample_atlas(test::fresh_folder(name + ".made"), header, records),
                          folder / "atlas.h5");
  return folder;
}

template <class Body>
std::string input_error_of(const Body& body) {
  try {
    body();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no InputError";
}

std::string refusal(DirectoryStatus status) {
  return input_error_of([&] { survey::require_startable(status, "some/folder", false); });
}

TEST(DirectoryStatus, AbsentAndEmptyFoldersHoldNothing) {
  EXPECT_EQ(survey::status_of("no/such/folder", sample_scene()), DirectoryStatus::none);
  const auto folder = test::fresh_folder("empty");
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::none);
  std::ofstream(folder / "notes.txt") << "something else";
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::none);
}

TEST(DirectoryStatus, AFolderInsideAFileHoldsNothing) {
  const auto folder = test::fresh_folder("file");
  std::ofstream(folder / "file") << "text";
  EXPECT_EQ(survey::status_of(folder / "file" / "inside", sample_scene()), DirectoryStatus::none);
}

TEST(DirectoryStatus, SegmentsWithoutAnArchiveAreUnfinished) {
  const auto folder = test::fresh_folder("unfinished");
  std::filesystem::create_directory(folder / "segments");
  std::ofstream(folder / "segments" / "lock") << "";
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::none) << "nothing was written yet";
  std::ofstream(folder / "segments" / "segment-000001.h5") << "rows";
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::unfinished);
}

TEST(DirectoryStatus, AnArchiveOfThisSceneIsFinished) {
  const auto folder = folder_with_atlas("finished");
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::finished);
  std::filesystem::create_directory(folder / "segments");  // left by a crash after the archive was written
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::finished);
}

TEST(DirectoryStatus, AFamilyThatFailedIsRemembered) {
  const auto folder = folder_with_atlas("failed", "failure (a NaN at node 3)");
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::finished_with_failures);
}

TEST(DirectoryStatus, AFamilyOfWhichOneSideFailedIsRemembered) {
  const auto folder = folder_with_atlas("side", "forwards: period limit (T = 30); backwards: failure (no orbit)");
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::finished_with_failures);
}

TEST(DirectoryStatus, AFamilyThatAStopCutMakesItUnfinished) {
  const auto folder = folder_with_atlas("stopped", "stopped (T = 7.5)");
  EXPECT_EQ(survey::status_of(folder, sample_scene()), DirectoryStatus::unfinished);
}

TEST(DirectoryStatus, AnArchiveOfAnotherSceneIsRefused) {
  const auto folder = folder_with_atlas("other_scene");
  scene::Scene other = sample_scene();
  other.text += "limits: {period: 20}\n";
  EXPECT_THAT(input_error_of([&] { (void)survey::status_of(folder, other); }),
              AllOf(HasSubstr("other_scene/atlas.h5"), HasSubstr("another scene"), HasSubstr("-o")));
}

TEST(DirectoryStatus, AnUnreadableArchiveIsRefused) {
  const auto folder = folder_with_atlas("torn");
  std::filesystem::resize_file(folder / "atlas.h5", std::filesystem::file_size(folder / "atlas.h5") / 2);
  EXPECT_THAT(input_error_of([&] { (void)survey::status_of(folder, sample_scene()); }), HasSubstr("torn/atlas.h5"));
  std::ofstream(folder / "atlas.h5", std::ios::trunc) << "not HDF5";
  EXPECT_THAT(input_error_of([&] { (void)survey::status_of(folder, sample_scene()); }), HasSubstr("torn/atlas.h5"));
}

TEST(Startable, NothingThereIsFine) {
  EXPECT_NO_THROW(survey::require_startable(DirectoryStatus::none, "some/folder", false));
  EXPECT_NO_THROW(survey::require_startable(DirectoryStatus::none, "some/folder", true));
}

TEST(Startable, ASurveyThereNeedsResume) {
  EXPECT_THAT(refusal(DirectoryStatus::finished),
              AllOf(HasSubstr("some/folder already holds a finished survey"), HasSubstr("nothing was changed"),
                    HasSubstr("--resume to accept it as it is")));
  EXPECT_THAT(refusal(DirectoryStatus::finished_with_failures), HasSubstr("a finished survey"));
  EXPECT_THAT(refusal(DirectoryStatus::unfinished),
              AllOf(HasSubstr("an unfinished survey"), HasSubstr("--resume to go on with it")));
  EXPECT_THAT(refusal(DirectoryStatus::finished_within_narrower_limits),
              AllOf(HasSubstr("a finished survey with narrower limits"), HasSubstr("--resume to go on with it")));
  EXPECT_NO_THROW(survey::require_startable(DirectoryStatus::finished, "some/folder", true));
  EXPECT_NO_THROW(survey::require_startable(DirectoryStatus::finished_with_failures, "some/folder", true));
  EXPECT_NO_THROW(survey::require_startable(DirectoryStatus::unfinished, "some/folder", true));
}

}  // namespace
}  // namespace directory_status_test
