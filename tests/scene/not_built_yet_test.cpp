#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"

namespace {

namespace scene = orbweaver::scene;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::string> sentences(const std::vector<std::string>& overrides) {
  return not_built_yet(scene::parse("system: {name: double_pendulum}\nstarts: {}\n", "text", overrides));
}

TEST(NotBuiltYet, SaysNothingAboutBaseFamilies) {
  EXPECT_THAT(sentences({}), IsEmpty());
  EXPECT_THAT(sentences({"limits.period=60", "continuation.step=0.5deg", "limits.time=60"}), IsEmpty());
}

TEST(NotBuiltYet, SaysNothingAboutBranchesAndEvents) {
  EXPECT_THAT(sentences({"survey.depth=3", "survey.subharmonics=16", "events.periods=[10]", "events.energies=[0]",
                         "survey.team_size=2"}),
              IsEmpty());
}

TEST(NotBuiltYet, SaysNothingAboutDampingAndDrives) {
  EXPECT_THAT(sentences({"system.effects=[damping]"}), IsEmpty());  // there is nothing to build: no families
  EXPECT_THAT(sentences({"system.effects=[damping, pivot_drive]", "continuation.free=pivot_amplitude"}), IsEmpty());
  EXPECT_THAT(sentences({"system.effects=[rod_inertia]"}), IsEmpty());
}

TEST(NotBuiltYet, SaysOneSentenceForEachThingAsked) {
  const std::vector<std::pair<std::string, std::string>> cases{{"section={coordinate: w1}", "section:"}};
  std::vector<std::string> all;
  for (const auto& [change, beginning] : cases) {
    const std::vector<std::string> said = sentences({change});
    ASSERT_THAT(said, SizeIs(1)) << change;
    EXPECT_EQ(said[0].find(beginning), 0U) << said[0];
    EXPECT_THAT(said[0], HasSubstr("yet"));
    all.push_back(change);
  }
  EXPECT_THAT(sentences(all), SizeIs(cases.size()));
}

}  // namespace
