#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"

namespace {

namespace scene = orbweaver::scene;
using testing::IsEmpty;

std::vector<std::string> sentences(const std::vector<std::string>& overrides) {
  return not_built_yet(scene::parse("system: {name: double_pendulum}\nstarts: {}\n", "text", overrides));
}

TEST(NotBuiltYet, SaysNothingAboutBaseFamilies) {
  EXPECT_THAT(sentences({}), IsEmpty());
  EXPECT_THAT(sentences({"limits.period=60", "continuation.step=0.5deg", "limits.time=60"}), IsEmpty());
}

TEST(NotBuiltYet, SaysNothingAboutBranchesAndEvents) {
  EXPECT_THAT(sentences({"survey.depth=3", "survey.subharmonics=16", "events.periods=[10]", "events.energies=[0]",
                         "survey.team_size=2", "section={coordinate: w1}"}),
              IsEmpty());
}

}  // namespace
