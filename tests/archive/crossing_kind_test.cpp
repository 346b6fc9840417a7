#include "orbweaver/archive/schema/crossing_kind.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace crossing_kind_test {
namespace {

using namespace orbweaver::archive;

TEST(CrossingKinds, HaveNamesOfTheirOwnByWhichTheyAreKnown) {
  std::set<std::string_view> names;
  for (int n = 0; n <= static_cast<int>(last_of(CrossingKind{})); ++n) {
    const auto kind = static_cast<CrossingKind>(n);
    EXPECT_TRUE(names.insert(name_of(kind)).second) << name_of(kind);
    EXPECT_EQ(crossing_kind_of(name_of(kind)), kind);
  }
}

TEST(CrossingKinds, OthersAreUnknown) {
  EXPECT_EQ(crossing_kind_of("neimark-sacker"), CrossingKind::unknown);
  EXPECT_EQ(crossing_kind_of(""), CrossingKind::unknown);
}

TEST(CrossingKinds, OnlySomeHaveASector) {
  EXPECT_TRUE(has_sector(CrossingKind::subharmonic));
  EXPECT_FALSE(has_sector(CrossingKind::krein));
  EXPECT_FALSE(has_sector(CrossingKind::fold_energy));
  EXPECT_TRUE(is_fold(CrossingKind::fold_energy));
  EXPECT_FALSE(is_fold(CrossingKind::branch_point));
}

}  // namespace
}  // namespace crossing_kind_test
