#include "orbweaver/survey/tree/family_end.hpp"

#include <gmock/gmock.h>

#include "orbweaver/continuation/ending.hpp"
#include "tree/end_text.hpp"

namespace family_end_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using continuation::EndReason;
using ::testing::ElementsAre;

BranchOutcome outcome_with(EndReason reason, const std::string& detail) {
  BranchOutcome outcome;
  outcome.end = {reason, detail};
  return outcome;
}

TEST(FamilyEnds, EveryReasonOfABranchIsReadBackAsItself) {
  for (int n = 0; n <= static_cast<int>(EndReason::failure); ++n) {
    const std::string text = end_text(outcome_with(static_cast<EndReason>(n), "T = 30"));
    EXPECT_THAT(ends_in(text), ElementsAre(static_cast<EndKind>(n))) << text;
    EXPECT_TRUE(text.ends_with(" (T = 30)")) << text;
  }
}

TEST(FamilyEnds, ABranchThatArrivedMetAFamilyUnlessItFailed) {
  BranchOutcome outcome = outcome_with(EndReason::stopped, "T = 8");
  outcome.arrival.push_back({8.25, -1.5, {}});
  EXPECT_EQ(end_text(outcome), "met a family of more symmetry (T = 8.25, E = -1.5)");
  EXPECT_THAT(ends_in(end_text(outcome)), ElementsAre(EndKind::met));
  outcome.end.reason = EndReason::failure;
  EXPECT_THAT(ends_in(end_text(outcome)), ElementsAre(EndKind::failure));
}

TEST(FamilyEnds, JoinedSaysWhereAndHowOftenAround) {
  LocateOutcome crossing;
  crossing.period = 8.0;
  crossing.multiplicity = 3;
  EXPECT_EQ(joined_text("In-Phase", crossing), "joined In-Phase at T = 24 (crossing at T = 8, 3 times around)");
  EXPECT_THAT(ends_in(joined_text("failure", crossing)), ElementsAre(EndKind::joined));
}

TEST(FamilyEnds, AFamilyWithTwoBranchesHasTwo) {
  const std::string text = both_ends_text(failure_text("a NaN"), end_text(outcome_with(EndReason::stopped, "")));
  EXPECT_EQ(text, "forwards: failure (a NaN); backwards: stopped");
  EXPECT_THAT(ends_in(text), ElementsAre(EndKind::failure, EndKind::stopped));
}

TEST(FamilyEnds, OtherTextsAreUnknown) {
  EXPECT_THAT(ends_in("the end of a failure"), ElementsAre(EndKind::unknown));
  EXPECT_THAT(ends_in(""), ElementsAre(EndKind::unknown));
  EXPECT_THAT(ends_in("forwards: cut off"), ElementsAre(EndKind::unknown));
}

}  // namespace
}  // namespace family_end_test
