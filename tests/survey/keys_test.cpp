#include "tasks/payload/keys.hpp"

#include <string>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"

namespace keys_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;

TEST(Keys, OfEventsHaveTheirBranchAndNumber) {
  const std::string key = event_key("0000.0001/003.q4.j1/0-", 12, "fold");
  EXPECT_EQ(key, "0000.0001/003.q4.j1/0-/012.fold");
  EXPECT_EQ(branch_of(key), "0000.0001/003.q4.j1/0-");
  EXPECT_EQ(event_number(key, "0000.0001/003.q4.j1/0-"), 12);
  EXPECT_EQ(event_number(key, "0000.0001"), 3);
}

TEST(Keys, OfBranchesHaveTheirParentAndDepth) {
  const std::string branch = "0000.0001+/003.q4.j1/0-/012.q2.j1/1";
  EXPECT_EQ(depth_of(branch), 2);
  EXPECT_EQ(parent_of(branch), "0000.0001+/003.q4.j1/0-");
  EXPECT_EQ(depth_of(parent_of(branch)), 1);
  EXPECT_EQ(parent_of(parent_of(branch)), "0000.0001+");
  EXPECT_EQ(depth_of("0000.0001+"), 0);
  EXPECT_EQ(parent_of("0000.0001+"), "");
}

TEST(Keys, LieOnWhatTheyBeginWithToASlash) {
  EXPECT_TRUE(lies_on("0000.0001/003.q4.j1", "0000.0001"));
  EXPECT_TRUE(lies_on("0000.0001/003.q4.j1/0/001.fold", "0000.0001"));
  EXPECT_FALSE(lies_on("0000.0001", "0000.0001")) << "itself";
  EXPECT_FALSE(lies_on("0000.0001+/003.q4.j1", "0000.0001")) << "another side";
  EXPECT_FALSE(lies_on("0000.0002/003.q4.j1", "0000.0001"));
}

TEST(Keys, SortAsTheirNumbersDo) {
  std::string last;
  for (const int number : {0, 9, 10, 999, 1000, 1001, 9999, 10000, 123456}) {
    const std::string key = event_key("0000.0001", number, "fold");
    EXPECT_LT(last, key);
    EXPECT_EQ(event_number(key, "0000.0001"), number);
    EXPECT_EQ(branch_of(key), "0000.0001");
    last = key;
  }
  last.clear();
  for (const int number : {0, 9999, 10000, 123456}) {
    const std::string key = base_key(number, number);
    EXPECT_LT(last, key);
    EXPECT_LT(key, base_key(number, number + 1));
    EXPECT_EQ(equilibrium_index(key), number);
    EXPECT_TRUE(key.starts_with(equilibrium_key(number) + "."));
    EXPECT_LT(base_key(number, number) + "/003.fold", base_key(number, number + 1));
    last = key;
  }
  EXPECT_EQ(base_key(2, 1), "0002.0001");
}

TEST(Keys, WithoutANumberAreRefused) {
  EXPECT_THROW((void)event_number("0000.0001/fold", "0000.0001"), core::EnvironmentError);
  EXPECT_THROW((void)event_number("0000.0001", "0000.0001"), core::EnvironmentError);
}

TEST(Keys, OfTasksSayWhatTheyAreAbout) {
  EXPECT_EQ(locate_key("0000.0001/003.fold"), "locate 0000.0001/003.fold");
  EXPECT_EQ(place_of(locate_key("0000.0001/003.fold")), "0000.0001/003.fold");
  EXPECT_EQ(place_of(start_key("0000.0001/003.q1.j0/0")), "0000.0001/003.q1.j0/0");
  EXPECT_EQ(place_of("0000.0001"), "0000.0001");
  EXPECT_EQ(place_of("sweep.0001"), "sweep.0001");
}

}  // namespace
}  // namespace keys_test
