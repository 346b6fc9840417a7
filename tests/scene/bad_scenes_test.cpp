#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/document/suggest.hpp"

// bad/messages.txt holds one line a scene of bad/: the whole message, which begins with the scene's file name;
// <systems> stands for the names of all systems.
namespace bad_scenes_test {
namespace {

namespace fs = std::filesystem;
namespace core = orbweaver::core;
namespace scene = orbweaver::scene;

const std::string all_systems = "<systems>";
const fs::path folder = fs::path(ORBWEAVER_SOURCE_DIR) / "tests/scene/bad";

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::map<std::string, std::string> expected_messages() {
  std::map<std::string, std::string> messages;
  std::ifstream stream(folder / "messages.txt");
  for (std::string line; std::getline(stream, line);) {
    if (const auto place = line.find(all_systems); place != std::string::npos)
      line.replace(place, all_systems.size(), orbweaver::document::alternatives(orbweaver::systems::system_names()));
    messages[line.substr(0, line.find(':'))] = line;
  }
  return messages;
}

std::vector<std::string> bad_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) { return fs::path(info.param).stem().string(); }

class BadScene : public testing::TestWithParam<std::string> {};

TEST_P(BadScene, IsRefusedWithItsMessage) {
  const auto messages = expected_messages();
  ASSERT_TRUE(messages.contains(GetParam())) << "bad/messages.txt has no line for it";
  try {
    static_cast<void>(scene::parse(read(folder / GetParam()), GetParam()));
    FAIL() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_EQ(error.what(), messages.at(GetParam()));
    EXPECT_EQ(error.status(), core::ExitStatus::wrong_input);
  }
}

INSTANTIATE_TEST_SUITE_P(Folder, BadScene, testing::ValuesIn(bad_scenes()), test_name);

TEST(BadScenes, HaveASceneForEveryMessage) {
  const std::vector<std::string> names = bad_scenes();
  EXPECT_GE(names.size(), 20U);
  EXPECT_EQ(expected_messages().size(), names.size());
}

TEST(BadScenes, AreNamedByTheirPathWhenLoaded) {
  const fs::path file = folder / "negative_period.yaml";
  try {
    static_cast<void>(scene::load(file));
    FAIL() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_EQ(std::string(error.what()).find(file.string() + ":3: limits.period: "), 0U) << error.what();
  }
}

TEST(BadScenes, AMissingFileAndAFolderAreRefused) {
  EXPECT_THROW(static_cast<void>(scene::load(folder / "nowhere.yaml")), core::InputError);
  EXPECT_THROW(static_cast<void>(scene::load(folder)), core::InputError);
}

TEST(BadScenes, DeepNestingIsASyntaxErrorAndNoCrash) {
  EXPECT_THROW(static_cast<void>(scene::parse(std::string(100000, '['), "deep.yaml")), core::InputError);
}

TEST(BadScenes, AListThatHoldsItselfIsRefused) {
  const std::string text = "system: {name: double_pendulum}\nstarts: {fixed_points: {grid: &a [*a]}}\n";
  EXPECT_THROW(static_cast<void>(scene::parse(text, "loop.yaml")), core::InputError);
}

}  // namespace
}  // namespace bad_scenes_test
