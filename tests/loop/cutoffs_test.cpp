#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop::cutoffs_test {
namespace {

bool has_only_factors_3_5_7(int n) {
  for (const int p : {3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

TEST(Cutoffs, GiveOddNodeNumbersWithSmallFactorsInEvenRatios) {
  int k = allowed_cutoff_at_least(7);
  EXPECT_EQ(k, 7);
  for (int next = next_cutoff(k); next < 200000; k = next, next = next_cutoff(k)) {
    EXPECT_TRUE(has_only_factors_3_5_7(2 * next + 1)) << next;
    const double ratio = (2.0 * next + 1.0) / (2.0 * k + 1.0);
    EXPECT_GE(ratio, 1.2) << k << " -> " << next;
    EXPECT_LE(ratio, 1.45) << k << " -> " << next;
  }
}

// 11, 13, 17 and 19 have larger factors, so that the smallest sizes cannot keep the ratio.
TEST(Cutoffs, StartWithOneHarmonic) {
  EXPECT_EQ(allowed_cutoff_at_least(-5), 1);
  EXPECT_EQ(allowed_cutoff_at_least(1), 1);
  std::vector<int> first{1};
  while (first.size() < 8) first.push_back(next_cutoff(first.back()));
  EXPECT_EQ(first, (std::vector<int>{1, 2, 3, 4, 7, 10, 13, 17}));
}

TEST(Cutoffs, AreTheFirstThatTheRatioAllows) {
  for (int k = 7, next = next_cutoff(k); next < 200000; k = next, next = next_cutoff(k)) {
    int first = 2 * k + 3;
    while (first < 1.22 * (2 * k + 1) || !has_only_factors_3_5_7(first)) first += 2;
    EXPECT_EQ(2 * next + 1, first) << k;
  }
}

TEST(Cutoffs, NextAndPreviousAreNeighbours) {
  for (int k = 1; k < 5000; k = next_cutoff(k)) {
    EXPECT_EQ(allowed_cutoff_at_least(k), k);
    EXPECT_EQ(previous_cutoff(next_cutoff(k)), k);
    EXPECT_EQ(allowed_cutoff_at_least(k + 1), next_cutoff(k));
  }
  EXPECT_EQ(previous_cutoff(1), 1) << "nothing lies below the smallest";
}

TEST(Cutoffs, FindTheNeighboursOfAnyNumber) {
  EXPECT_EQ(allowed_cutoff_at_least(8), 10);
  EXPECT_EQ(next_cutoff(8), 10);
  EXPECT_EQ(previous_cutoff(8), 7);
}

TEST(Cutoffs, EndSomewhere) { EXPECT_THROW(static_cast<void>(allowed_cutoff_at_least(1 << 24)), core::MisuseError); }

}  // namespace
}  // namespace orbweaver::loop::cutoffs_test
