// Families that come near another one of the same symmetries: a step beside it stays on its own.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/double_well.hpp"
#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace near_families_test {
namespace {

using namespace orbweaver;

// The family turns back in T at 15.37718; beside that place another one goes on to T = 22 and farther. A step that was
// shortened once had ended on it, from where the predictions were no better than from the longer one.
TEST(NearFamilies, ATurnBesideAnotherFamilyIsFollowedWhateverTheStep) {
  const auto with = [](const std::string& step) {
    return test::survey_of(
        test::double_well({{"t", -0.047}, {"w", 3.085}, {"k", 0.1294}, {"c", 0.2902}}),
        {"starts.fixed_points.grid=[[-1], [0], [0], [0]]", "survey.depth=1", "survey.subharmonics=3",
         "limits.period=22", "limits.energy=[-1, 0.3]", "continuation.step=" + step});
  };
  const test::Atlas usual = with("0.05");
  const std::string name = "Equilibrium 1, mode 2 T3";
  const std::vector<double> periods = usual.column("period", name);
  EXPECT_LT(*std::max_element(periods.begin(), periods.end()), 15.3771824);
  EXPECT_TRUE(usual.crossing(name, "fold-period", 15.3771823865).has_value());
  EXPECT_THAT(usual.end_of(name), testing::StartsWith("energy limit"));
  for (const std::string step : {"0.02", "0.1"}) {
    SCOPED_TRACE(step);
    test::expect_same_tree(usual, with(step));
  }
}

}  // namespace
}  // namespace near_families_test
