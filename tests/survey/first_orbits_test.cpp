// Where the first orbit of a family is asked for decides nothing: not far out, nor where rounding hides it.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "survey/atlas.hpp"
#include "survey/same_tree.hpp"
#include "survey/scenes.hpp"

namespace {

using namespace orbweaver;
using testing::Contains;
using testing::Not;

survey::Summary survey_of(const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  survey::Summary summary = test::run(comm, test::quick_scene(overrides), "first");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  return summary;
}

TEST(FirstOrbits, FarOutNothingBetweenThemAndTheEquilibriumIsLost) {
  const std::vector<std::string> common{"limits.period=15", "survey.subharmonics=4"};
  const auto at = [&](const std::string& start) {
    std::vector<std::string> overrides = common;
    overrides.push_back("continuation.start=" + start);
    return test::Atlas(survey_of(overrides).atlas);
  };
  const test::Atlas near = at("0.5deg");
  ASSERT_GE(near.crossings().rows(), 6U);
  for (const std::string start : {"30deg", "60deg", "90deg"}) {
    SCOPED_TRACE(start);
    test::expect_same_tree(near, at(start));
  }
}

TEST(FirstOrbits, BelowRoundingAreToldOfOnceAFamily) {
  const survey::Summary summary =
      survey_of({"continuation.start=1e-14rad", "limits.steps=2", "compute.certificate=none"});
  const auto told_of = [](const std::string& key) {
    return testing::StartsWith(key + ": a first orbit at continuation.start would be lost in rounding: it is taken 1");
  };
  EXPECT_THAT(summary.remarks, Contains(told_of("0001.0000")).Times(1)) << "beside (0, pi)";
  EXPECT_THAT(summary.remarks, Not(Contains(told_of("0000.0000")))) << "beside (0, 0)";
}

}  // namespace
