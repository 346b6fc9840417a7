// Wells without symmetry but time reversal: families that go through a crossing of order 3, and what lies between a
// crossing and the first orbit. Where that is and how long steps are decides nothing.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/uneven_well.hpp"
#include "survey/atlas.hpp"
#include "survey/same_tree.hpp"
#include "survey/scenes.hpp"

namespace order_three_test {
namespace {

using namespace orbweaver;

test::Atlas survey_of(const std::map<std::string, double>& parameters, const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  std::vector<std::string> all{"starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                               "starts.fixed_points.grid=[[0], [0], [0], [0]]", "starts.sweep.period=auto",
                               "survey.subharmonics=4", "survey.depth=2"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
  const auto folder = test::fresh_folder("uneven_well", comm.get());
  const survey::Summary summary = survey::run_survey(comm, scene, test::uneven_well(parameters), folder, {});
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  return test::Atlas(summary.atlas);
}

// The way from the crossing at T = 3.95599 to orbits of the family makes an angle of 75 degrees with the kernel.
TEST(OrderThree, FamiliesThatLeaveFarAsideOfTheKernelAreFollowed) {
  const std::map<std::string, double> well{{"w1", 1.0},   {"w2", 0.773}, {"a", 0.075}, {"b", -0.196}, {"c", 0.556},
                                           {"d", 0.152}, {"e", 0.452},  {"f", 3.593}, {"g", 0.984}};
  const auto with = [&](const std::string& key) {
    return survey_of(well, {"limits.energy=[-.inf, 1.6]", "limits.period=26", "continuation." + key});
  };
  const test::Atlas usual = with("start=0.0087");
  EXPECT_EQ(usual.families().texts("name").size(), 9U);
  for (const std::string key : {"start=0.0017", "start=0.0436", "step=0.25"}) {
    SCOPED_TRACE(key);
    test::expect_same_tree(usual, with(key));
  }
}

// From one crossing of order 3 to another, each of which is met far aside of its kernel.
TEST(OrderThree, FamiliesFromCrossingToCrossingAreToldOnce) {
  const test::Atlas atlas = survey_of({{"w1", 1.0},
                                       {"w2", 0.798},
                                       {"a", -0.397},
                                       {"b", -0.104},
                                       {"c", -0.414},
                                       {"d", -0.433},
                                       {"e", 0.602},
                                       {"f", 4.606},
                                       {"g", 1.241}},
                                      {"limits.energy=[-.inf, 1.5]", "limits.period=12", "survey.subharmonics=3",
                                       "survey.depth=1"});
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 2", "subharmonic", 3.7054178845).has_value());
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 2", "subharmonic", 3.6081558102).has_value());
}

// Of a family born at E = 0.21868 the first orbit has an index of 2.02 where it is far out; nearer, 1.996.
TEST(OrderThree, WhatPassesBetweenBirthAndFirstOrbitIsFound) {
  const std::map<std::string, double> well{{"w1", 1.0},     {"w2", 0.773}, {"a", -0.236}, {"b", 0.265}, {"c", -0.025},
                                           {"d", -0.492}, {"e", 0.422},  {"f", 3.747},  {"g", 0.718}};
  const auto from = [&](const std::string& start) {
    return survey_of(well, {"limits.energy=[-.inf, 0.8]", "limits.period=31", "continuation.start=" + start});
  };
  const test::Atlas usual = from("0.0087");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 1 DD1", "branch-point", 26.49981049).has_value());
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 2 T3D", "branch-point", 26.7274).has_value());
  test::expect_same_tree(usual, from("0.0436"));
}

}  // namespace
}  // namespace order_three_test
