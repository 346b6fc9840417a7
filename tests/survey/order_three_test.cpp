// Wells without symmetry but time reversal: families that go through a crossing of order 3. Where their first orbit
// lies and how long steps are decides nothing.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace order_three_test {
namespace {

using namespace orbweaver;
using test::survey_of;
using test::well;

// The way from the crossing at T = 3.95599 to orbits of the family makes an angle of 75 degrees with the kernel.
TEST(OrderThree, FamiliesThatLeaveFarAsideOfTheKernelAreFollowed) {
  const std::map<std::string, double> uneven = well({0.773, 0.075, -0.196, 0.556, 0.152, 0.452, 3.593, 0.984});
  const auto with = [&](const std::string& key) {
    return survey_of(uneven, {"limits.energy=[-.inf, 1.6]", "limits.period=26", "continuation." + key});
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
  const test::Atlas atlas =
      survey_of(well({0.798, -0.397, -0.104, -0.414, -0.433, 0.602, 4.606, 1.241}),
                {"limits.energy=[-.inf, 1.5]", "limits.period=12", "survey.subharmonics=3", "survey.depth=1"});
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 2", "subharmonic", 3.7054178845).has_value());
  EXPECT_TRUE(atlas.crossing("Equilibrium 1, mode 2", "subharmonic", 3.6081558102).has_value());
}

// The first orbit of T3-2 lies 66 degrees aside of the kernel, beside a fold: with a start of 0.0436 it was refused, or
// the step behind it led on to another family. Of T3-2D1 the way to the first orbit passes its base's own family.
TEST(OrderThree, FirstOrbitsFarOutAreOnTheirFamily) {
  const auto with = [](const std::string& key) {
    return survey_of(well({0.7196, -0.2206, -0.2408, 0.1925, 0.4565, 0.5236, 4.874, 1.287}),
                     {"limits.energy=[-.inf, 1.95]", "limits.period=26", "continuation." + key});
  };
  const test::Atlas usual = with("start=0.0087");
  EXPECT_EQ(usual.families().texts("name").size(), 15U);
  for (const std::string key : {"start=0.0436", "step=0.25"}) {
    SCOPED_TRACE(key);
    test::expect_same_tree(usual, with(key));
  }
}

// An index of 1.998 on mode 2 at T = 5.476: another family begins on the other side. With a start of 0.02 a step led
// there.
TEST(OrderThree, AFamilyThatTurnsAsideBeforeAnIndexOfTwoIsFollowed) {
  const auto with = [](const std::string& key) {
    return survey_of(well({1.13999, -0.314169, -0.136285, -0.185383, 0.194493, 0.502516, 4.63217, 0.303496}),
                     {"limits.energy=[-.inf, 2]", "limits.period=26", "survey.depth=0", "continuation." + key});
  };
  const test::Atlas usual = with("start=0.0087");
  EXPECT_NEAR(usual.orbits().reals("period").back(), 3.3728832608, 1e-8);
  for (const std::string key : {"start=0.02", "start=0.0436", "step=0.25"}) {
    SCOPED_TRACE(key);
    test::expect_same_tree(usual, with(key));
  }
}

}  // namespace
}  // namespace order_three_test
