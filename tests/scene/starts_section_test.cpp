#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"

namespace starts_section_test {
namespace {

namespace fs = std::filesystem;
namespace scene = orbweaver::scene;
using testing::HasSubstr;

const fs::path folder = fs::path(testing::TempDir()) / "orbweaver_starts_section";

void write(const std::string& name, const std::string& text) {
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << text;
}

std::string table(double last) {
  std::string text = "t,q,p\n";
  for (int j = 0; j < 8; ++j) text += std::to_string(0.7 * j) + "," + std::to_string(j + last) + ",1\n";
  return text;
}

std::string scene_with(const std::string& starts) {
  return "system: {name: harmonic_oscillator}\nstarts: {" + starts + "}\n";
}

scene::Scene loaded(const std::string& starts) {
  write("scene.yaml", scene_with(starts));
  return scene::load(folder / "scene.yaml");
}

std::string refusal(const std::string& starts) {
  try {
    static_cast<void>(loaded(starts));
  } catch (const orbweaver::core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StartsSection, KeepsTheHashOfAFileInTheScene) {
  write("loop.csv", table(0.0));
  const std::string starts = "loops: [{file: loop.csv, period: 6.3, name: Round}]";
  const scene::Scene read = loaded(starts);
  ASSERT_EQ(read.loops.size(), 1U);
  EXPECT_EQ(read.loops[0].samples.states.size(), 8U);
  EXPECT_EQ(read.loops[0].file.hash, orbweaver::core::file_hash({folder / "loop.csv"}));
  EXPECT_THAT(read.text, HasSubstr(read.loops[0].file.hash));
  const scene::Scene stored = scene::parse(read.text, "stored");
  EXPECT_EQ(stored.loops[0].samples.states.size(), 0U);
  EXPECT_TRUE(scene::differences(stored, read).empty());

  // The same file elsewhere is no other start; another one in its place is.
  write("moved.csv", table(0.0));
  EXPECT_TRUE(scene::differences(stored, loaded("loops: [{file: moved.csv, period: 6.3, name: Round}]")).empty());
  write("loop.csv", table(1.0));
  const auto changed = scene::differences(stored, loaded(starts));
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].key, "starts.loops");
  EXPECT_THAT(refusal("loops: [{file: loop.csv, period: 6.3, hash: " + read.loops[0].file.hash + "}]"),
              HasSubstr("starts.loops[0].hash: expected a file with this hash, " + read.loops[0].file.hash));
}

TEST(StartsSection, TakesATableWithAByteOrderMark) {
  write("loop.csv", "\xef\xbb\xbf" + table(0.0));
  EXPECT_EQ(loaded("loops: [{file: loop.csv, period: 6.3}]").loops[0].samples.states.size(), 8U);
}

TEST(StartsSection, RefusesWhatItCannotStartFrom) {
  write("other.h5", "nothing");
  EXPECT_THAT(refusal("loops: [{file: none.csv, period: 6.3}]"),
              HasSubstr("starts.loops[0].file: expected a file that can be read, told from the scene's folder, got "
                        "`none.csv`, which does not exist; check the path"));
  EXPECT_THAT(refusal("orbits: [{archive: other.h5, family: A, near: {period: 9, energy: 1}}]"),
              HasSubstr("starts.orbits[0].near: expected one of `period`, `energy` and `step`"));
  EXPECT_THAT(refusal("orbits: [{archive: other.h5, near: {period: 9}}]"), HasSubstr("expected the key `family`"));
  EXPECT_THAT(refusal("recurrences: {state: [1, 0], time: 5, period: [1, 20]}"),
              HasSubstr("starts.recurrences.period: expected periods up to `time`, 5, got 20"));
  EXPECT_THAT(refusal("recurrences: {state: [1], time: 50, period: [1, 20]}"),
              HasSubstr("expected 2 numbers, for q, p"));
  EXPECT_THAT(refusal("states: [{state: [1, 0]}]"), HasSubstr("expected the key `period`"));
}

TEST(StartsSection, TakesAnAtlasByItsSurveysFolder) {
  const std::string starts = "orbits: [{archive: other, family: A, near: {period: 9}}]";
  fs::remove_all(folder / "other");
  fs::create_directories(folder / "other" / "segments");
  EXPECT_THAT(refusal(starts), HasSubstr("other' is the folder of a survey that has not come to its end"));
  write("other/atlas.h5", "nothing");
  const scene::Scene read = loaded(starts);
  ASSERT_EQ(read.orbits.size(), 1U);
  EXPECT_EQ(read.orbits[0].archive.file, folder / "other" / "atlas.h5");
  EXPECT_EQ(read.orbits[0].archive.hash, orbweaver::core::file_hash({folder / "other" / "atlas.h5"}));
  EXPECT_THAT(refusal("loops: [{file: other, period: 6.3}]"), HasSubstr("expected a file that can be read"));
}

TEST(StartsSection, NamesWhatDiffersOfRecurrences) {
  const auto with = [](const std::string& key, const std::string& value) {
    std::map<std::string, std::string> keys{
        {"state", "[1, 0]"}, {"time", "50"}, {"period", "[1, 20]"}, {"tolerance", "0.1"}, {"most", "9"}};
    keys[key] = value;
    std::string text = "recurrences: {";
    for (const auto& [name, given] : keys) text += name + ": " + given + ", ";
    return loaded(text + "}");
  };
  const scene::Scene before = with("most", "9");
  for (const auto& [key, value] : std::map<std::string, std::string>{
           {"state", "[1, 1]"}, {"time", "60"}, {"period", "[1, 21]"}, {"tolerance", "0.2"}, {"most", "10"}}) {
    const auto differing = scene::differences(before, with(key, value));
    ASSERT_EQ(differing.size(), 1U) << key;
    EXPECT_EQ(differing[0].key, "starts.recurrences." + key);
    EXPECT_EQ(differing[0].change, scene::Change::other);
  }
}

TEST(StartsSection, TakesAllKindsTogether) {
  write("loop.csv", table(0.0));
  write("other.h5", "nothing");
  const scene::Scene read = loaded(
      "fixed_points: {grid: [[0], [0]]}, states: [{state: [1, 0], period: 6.3}], "
      "orbits: [{archive: other.h5, family: A, near: {step: 3}}], loops: [{file: loop.csv, period: 6.3}], "
      "recurrences: {state: [1, 0], time: 50, period: [1, 20], tolerance: 0.2, most: 7}");
  EXPECT_EQ(read.states.size(), 1U);
  ASSERT_EQ(read.orbits.size(), 1U);
  EXPECT_EQ(read.orbits[0].near, scene::OrbitStart::Near::step);
  EXPECT_EQ(read.orbits[0].value, 3.0);
  EXPECT_EQ(read.orbits[0].archive.file, folder / "other.h5");
  ASSERT_TRUE(read.recurrences.has_value());
  EXPECT_EQ(read.recurrences->tolerance, 0.2);
  EXPECT_EQ(read.recurrences->most, 7);
}

}  // namespace
}  // namespace starts_section_test
