#include "orbweaver/survey/state/standing.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"

namespace {

using namespace orbweaver;
using survey::Standing;
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

std::string refusal(Standing standing) {
  return input_error_of([&] { survey::require_startable(standing, "some/folder", false); });
}

TEST(Standing, AbsentAndEmptyFoldersHoldNothing) {
  EXPECT_EQ(survey::standing_of("no/such/folder", sample_scene()), Standing::none);
  const auto folder = test::fresh_folder("empty");
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::none);
  std::ofstream(folder / "notes.txt") << "something else";
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::none);
}

TEST(Standing, AFolderInsideAFileHoldsNothing) {
  const auto folder = test::fresh_folder("file");
  std::ofstream(folder / "file") << "text";
  EXPECT_EQ(survey::standing_of(folder / "file" / "inside", sample_scene()), Standing::none);
}

TEST(Standing, SegmentsWithoutAnArchiveAreUnfinished) {
  const auto folder = test::fresh_folder("unfinished");
  std::filesystem::create_directory(folder / "segments");
  std::ofstream(folder / "segments" / "lock") << "";
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::none) << "nothing was written yet";
  std::ofstream(folder / "segments" / "segment-000001.h5") << "rows";
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::unfinished);
}

TEST(Standing, AnArchiveOfThisSceneIsFinished) {
  const auto folder = folder_with_atlas("finished");
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::finished);
  std::filesystem::create_directory(folder / "segments");  // left by a crash after the archive was written
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::finished);
}

TEST(Standing, AFamilyThatFailedIsRemembered) {
  const auto folder = folder_with_atlas("failed", "failure (a NaN at node 3)");
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::finished_with_failures);
}

TEST(Standing, AFamilyOfWhichOneSideFailedIsRemembered) {
  const auto folder = folder_with_atlas("side", "forwards: period limit (T = 30); backwards: failure (no orbit)");
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::finished_with_failures);
}

TEST(Standing, AFamilyThatAStopCutMakesItUnfinished) {
  const auto folder = folder_with_atlas("stopped", "stopped (T = 7.5)");
  EXPECT_EQ(survey::standing_of(folder, sample_scene()), Standing::unfinished);
}

TEST(Standing, AnArchiveOfAnotherSceneIsRefused) {
  const auto folder = folder_with_atlas("other_scene");
  scene::Scene other = sample_scene();
  other.text += "limits: {period: 20}\n";
  EXPECT_THAT(input_error_of([&] { (void)survey::standing_of(folder, other); }),
              AllOf(HasSubstr("other_scene/atlas.h5"), HasSubstr("another scene"), HasSubstr("-o")));
}

TEST(Standing, AnUnreadableArchiveIsRefused) {
  const auto folder = folder_with_atlas("torn");
  std::filesystem::resize_file(folder / "atlas.h5", std::filesystem::file_size(folder / "atlas.h5") / 2);
  EXPECT_THAT(input_error_of([&] { (void)survey::standing_of(folder, sample_scene()); }), HasSubstr("torn/atlas.h5"));
  std::ofstream(folder / "atlas.h5", std::ios::trunc) << "not HDF5";
  EXPECT_THAT(input_error_of([&] { (void)survey::standing_of(folder, sample_scene()); }), HasSubstr("torn/atlas.h5"));
}

TEST(Startable, NothingThereIsFine) {
  EXPECT_NO_THROW(survey::require_startable(Standing::none, "some/folder", false));
  EXPECT_NO_THROW(survey::require_startable(Standing::none, "some/folder", true));
}

TEST(Startable, ASurveyThereNeedsResume) {
  EXPECT_THAT(refusal(Standing::finished),
              AllOf(HasSubstr("some/folder already holds a finished survey"), HasSubstr("nothing was changed"),
                    HasSubstr("--resume to accept it as it is")));
  EXPECT_THAT(refusal(Standing::finished_with_failures), HasSubstr("a finished survey"));
  EXPECT_THAT(refusal(Standing::unfinished),
              AllOf(HasSubstr("an unfinished survey"), HasSubstr("--resume to go on with it")));
  EXPECT_NO_THROW(survey::require_startable(Standing::finished, "some/folder", true));
  EXPECT_NO_THROW(survey::require_startable(Standing::finished_with_failures, "some/folder", true));
  EXPECT_NO_THROW(survey::require_startable(Standing::unfinished, "some/folder", true));
}

}  // namespace
