#include <gtest/gtest.h>

#include "orbweaver/document/suggest.hpp"

namespace suggest_test {
namespace {

using namespace orbweaver::document;

TEST(Suggest, EditDistanceCountsInsertionsDeletionsAndExchanges) {
  EXPECT_EQ(edit_distance("period", "period"), 0U);
  EXPECT_EQ(edit_distance("perid", "period"), 1U);
  EXPECT_EQ(edit_distance("periods", "period"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
}

TEST(Suggest, NearestIsNearEnoughOrNothing) {
  EXPECT_EQ(nearest("perid", {"energy", "period", "steps"}), "period");
  EXPECT_EQ(nearest("In-Fase", {"Out-Phase", "In-Phase"}), "In-Phase");
  EXPECT_EQ(nearest("colour", {"energy", "period", "steps"}), "");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(nearest("zz", {"g"}), "");
}

TEST(Suggest, AlternativesReadAsASentence) {
  EXPECT_EQ(alternatives({}), "");
  EXPECT_EQ(alternatives({"a"}), "a");
  EXPECT_EQ(alternatives({"a", "b", "c"}), "a, b or c");
}

}  // namespace
}  // namespace suggest_test
