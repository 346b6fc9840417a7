// Wells without symmetry but time reversal: what lies between the birth of a family and its first orbit, or within the
// step behind it. Where that orbit lies and how long steps are decides nothing.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace births_test {
namespace {

using namespace orbweaver;
using test::survey_of;
using test::well;

// Of a family born at E = 0.21868 the first orbit has an index of 2.02 where it is far out; nearer, 1.996.
TEST(Births, WhatPassesBetweenBirthAndFirstOrbitIsFound) {
  const std::map<std::string, double> uneven = well({0.773, -0.236, 0.265, -0.025, -0.492, 0.422, 3.747, 0.718});
  const auto from = [&](const std::string& start) {
    return survey_of(uneven, {"limits.energy=[-.inf, 0.8]", "limits.period=31", "continuation.start=" + start});
  };
  const test::Atlas usual = from("0.0087");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 1 DD1", "branch-point", 26.49981049).has_value());
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 2 T3D", "branch-point", 26.7274).has_value());
  test::expect_same_tree(usual, from("0.0436"));
}

// Behind the crossing where T3 is born its index is above 2, by 5e-6 at most, and comes back to it at T = 16.0826.
TEST(Births, AnIndexThatHardlyLeavesTwoAtABirthIsFollowed) {
  const auto with = [](const std::string& key) {
    return survey_of(well({1.366, 0.02826, -0.3534, 0.04317, -0.473, 0.5641, 4.957, 1.15}),
                     {"limits.energy=[-.inf, 0.9]", "limits.period=17", "survey.depth=1", "continuation." + key});
  };
  const test::Atlas usual = with("start=0.0087");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 1 T3", "branch-point", 16.08263894).has_value());
  for (const std::string key : {"start=0.0017", "start=0.0436", "step=0.25"}) {
    SCOPED_TRACE(key);
    test::expect_same_tree(usual, with(key));
  }
}

// T and E turn beside the birth of T3, E by 1.8e-8 of itself: slopes tell it, from first orbits near and far.
TEST(Births, FoldsBesideABirthAreFoundWhereverTheFirstOrbitLies) {
  const auto from = [](const std::string& start) {
    return survey_of(well({1.092, 0.4433, 0.34, -0.3629, -0.3784, 0.5211, 3.145, 0.4647}),
                     {"limits.energy=[-.inf, 0.5]", "limits.period=19", "survey.subharmonics=3", "survey.depth=1",
                      "continuation.start=" + start});
  };
  for (const std::string start : {"0.0017", "0.0087", "0.0436", "0.06"}) {
    SCOPED_TRACE(start);
    const test::Atlas atlas = from(start);
    EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 1 T3", "fold-energy", 17.8682061).has_value());
    EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 1 T3", "fold-period", 17.8682061).has_value());
  }
}

// x = 0 is invariant, but no symmetry keeps it so: at the branch point of its family another goes through, along it
// too. First orbits along the kernel alone were drawn into the crossing, and taken for the base's own.
TEST(Births, AFamilyThatGoesThroughABranchPointStartsAlongItsSlope) {
  const auto from = [](const std::string& start) {
    return survey_of(
        {{"w1", 1.1}, {"w2", 1.0}, {"a", 0.3}, {"b", 0.6}, {"c", 0.0}, {"d", 0.0}, {"e", 0.0}, {"f", 0.3}, {"g", 0.2}},
        {"limits.energy=[-.inf, 0.4]", "limits.period=15", "survey.subharmonics=2", "survey.depth=1",
         "continuation.start=" + start});
  };
  const test::Atlas usual = from("0.0087");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 1", "branch-point", 6.03415141).has_value());
  EXPECT_EQ(usual.families().texts("name").size(), 4U);
  for (const std::string start : {"0.0017", "0.0436"}) {
    SCOPED_TRACE(start);
    test::expect_same_tree(usual, from(start));
  }
}

// T of D rises to 8.45034 and falls: which steps see an orbit beyond a limit just below decides nothing.
TEST(Births, AStepOverAFoldBeyondALimitEndsAtTheLimit) {
  const auto with = [](const std::string& key) {
    return survey_of(well({0.9585, 0.06634, 0.4531, 0.1905, 0.01549, 0.6088, 4.352, 0.2594}),
                     {"limits.energy=[-.inf, 1]", "limits.period=8.4503", "survey.subharmonics=3", "survey.depth=1",
                      "continuation." + key});
  };
  for (const std::string key : {"start=0.0017", "start=0.0087", "start=0.0436", "step=0.25"}) {
    SCOPED_TRACE(key);
    const test::Atlas atlas = with(key);
    EXPECT_EQ(atlas.crossings().rows(), 7U);
    EXPECT_EQ(atlas.end_of("Equilibrium 1, mode 2 D"), "period limit (T = 8.4503)");
  }
}

// With steps of 0.25 the second orbit of T3D lies beyond two branch points, between which its index rises to 50.
TEST(Births, PairsWithinALongStepAreFound) {
  const auto with = [](const std::string& key) {
    return survey_of(well({0.9585, 0.06634, 0.4531, 0.1905, 0.01549, 0.6088, 4.352, 0.2594}),
                     {"limits.energy=[-.inf, 1.88]", "limits.period=26", "continuation." + key});
  };
  const test::Atlas usual = with("start=0.0087");
  EXPECT_TRUE(usual.crossing("Equilibrium 1, mode 2 T3D", "branch-point", 22.5273).has_value());
  test::expect_same_tree(usual, with("step=0.25"));
}

}  // namespace
}  // namespace births_test
