#include "orbweaver/scene/known_keys.hpp"

#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/document/suggest.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::scene {
void PrintTo(const KnownKey& key, std::ostream* out) { *out << key.path; }
}  // namespace orbweaver::scene

namespace known_keys_test {
namespace {

namespace core = orbweaver::core;
namespace scene = orbweaver::scene;
using scene::KnownKey;

/// A scene in which the key may stand, as far as it needs others.
std::string scene_around(const KnownKey& key) {
  const std::vector<std::pair<std::string, std::string>> needs{
      {"starts.states[]", "starts: {states: [{state: [0, 0, 1, 1], period: 6}]}"},
      {"starts.orbits[]", "starts: {orbits: [{archive: a.h5, family: F, near: {period: 9}}]}"},
      {"starts.loops[]", "starts: {loops: [{file: loop.csv, period: 6}]}"},
      {"starts.recurrences.", "starts: {recurrences: {state: [0, 0, 1, 1], time: 9, period: [1, 2]}}"},
      {"continuation.hold", "continuation: {free: m2}"},
      {"limits.parameter", "continuation: {free: m2}"},
      {"loci[]", "loci: [{of: [period-doubling], free: [m2]}]"},
      {"section.", "section: {coordinate: w1}"},
      {"limits.guards", "system: {name: pcr3bp}"},
  };
  std::string text;
  for (const auto& [path, needed] : needs)
    if (key.path.starts_with(path)) text = needed + "\n";
  if (!text.starts_with("system:")) text += "system: {name: double_pendulum}\n";
  if (!text.starts_with("starts:")) text += "starts: {}\n";
  return text;
}

void put(YAML::Node node, std::string_view path, const YAML::Node& value) {
  const std::string step(path.substr(0, path.find('.')));
  if (step.size() == path.size())
    node[step] = value;
  else if (step.ends_with("[]"))
    put(node[step.substr(0, step.size() - 2)][0], path.substr(step.size() + 1), value);
  else
    put(node[step], path.substr(step.size() + 1), value);
}

std::string scene_with(const KnownKey& key, const std::string& value) {
  YAML::Node root = YAML::Load(scene_around(key));
  put(root, key.path, YAML::Load(value));
  YAML::Emitter emitter;
  emitter << root;
  return emitter.c_str();
}

/// As messages have it, for the double pendulum.
std::string with_names(std::string text) {
  for (const auto& [general, names] : std::vector<std::pair<std::string, std::string>>{
           {"the program's systems", orbweaver::document::alternatives(orbweaver::systems::system_names())},
           {"the system's parameters", "m1, m2, l1, l2 or g"},
           {"the system's coordinates", "th1, th2, w1 or w2"}})
    if (const auto place = text.find(general); place != std::string::npos) text.replace(place, general.size(), names);
  return text;
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(scene::parse(text, "text"));
    return "";
  } catch (const core::InputError& error) {
    return error.what();
  }
}

class EveryKnownKey : public testing::TestWithParam<KnownKey> {};
class KeyWithDefault : public testing::TestWithParam<KnownKey> {};

/// Those whose default is YAML.
std::vector<KnownKey> keys_with_defaults() {
  std::vector<KnownKey> found;
  for (const KnownKey& key : scene::known_keys())
    if (key.standard.starts_with('`')) found.push_back(key);
  return found;
}

TEST_P(EveryKnownKey, IsReadAndRefusesWhatItDoesNotTakeInTheWordsOfTheReference) {
  const KnownKey& key = GetParam();
  const bool takes_many = key.value.starts_with("a map") || key.value.starts_with("a list");
  const std::string message = refusal_of(scene_with(key, takes_many ? "7" : "{}"));
  std::string path(key.path);
  for (auto place = path.find("[]"); place != std::string::npos; place = path.find("[]")) path.replace(place, 2, "[0]");
  ASSERT_THAT(message, testing::HasSubstr(path + ": "));
  const std::string mark = "expected ";
  const auto from = message.rfind(mark);
  ASSERT_NE(from, std::string::npos) << message;
  const std::string expected = message.substr(from + mark.size(), message.find(", got ") - from - mark.size());
  EXPECT_THAT(with_names(std::string(key.value)), testing::StartsWith(expected)) << message;
}

TEST_P(KeyWithDefault, LeftOutHasTheDefaultOfTheReference) {
  const KnownKey& key = GetParam();
  const std::string standard(key.standard.substr(1, key.standard.find('`', 1) - 1));
  const scene::Scene without = scene::parse(scene_around(key), "text");
  for (const scene::Difference& difference : differences(without, scene::parse(scene_with(key, standard), "text")))
    ADD_FAILURE() << difference.key << " is " << difference.before << " when left out, " << difference.now
                  << " as said";
}

std::string test_name(const testing::TestParamInfo<KnownKey>& info) {
  std::string name;
  for (const char c : info.param.path) name += c == '.' || c == '[' ? "_" : c == ']' ? "" : std::string(1, c);
  return name;
}

INSTANTIATE_TEST_SUITE_P(Reference, EveryKnownKey,
                         testing::ValuesIn(scene::known_keys().begin(), scene::known_keys().end()), test_name);
INSTANTIATE_TEST_SUITE_P(Reference, KeyWithDefault, testing::ValuesIn(keys_with_defaults()), test_name);

TEST(KnownKeys, MostHaveADefaultThatIsHeldAgainstTheReader) { EXPECT_GE(keys_with_defaults().size(), 35U); }

TEST(KnownKeys, StandOnceBehindTheMapsThatHoldThem) {
  std::set<std::string_view> before{""};
  for (const KnownKey& key : scene::known_keys()) {
    const std::string_view section = key.section();
    EXPECT_TRUE(before.contains(section.ends_with("[]") ? section.substr(0, section.size() - 2) : section)) << key.path;
    EXPECT_TRUE(before.insert(key.path).second) << key.path;
    EXPECT_FALSE(key.meaning.empty()) << key.path;
  }
}

TEST(KnownKeys, OfAnEntryAreThoseOfAnyEntry) {
  EXPECT_THAT(scene::names_of_keys("loci[12]"), testing::ElementsAre("of", "free", "range"));
  EXPECT_THAT(scene::names_of_keys("starts.orbits[0].near"), testing::ElementsAre("period", "energy", "step"));
  EXPECT_THROW(static_cast<void>(scene::names_of_keys("limit")), std::logic_error);
}

}  // namespace
}  // namespace known_keys_test
