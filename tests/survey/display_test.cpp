#include <limits>

#include <gmock/gmock.h>

#include "run/display.hpp"

namespace display_test {
namespace {

using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

FamilyState family(const std::string& name) {
  FamilyState f;
  f.name = name;
  f.orbits = 153;
  f.period = 30.0;
  f.level = 2.984322;
  f.cutoff = 447;
  f.running = false;
  f.end = "period limit (T = 30)";
  return f;
}

TEST(Display, AFamilyLosesNumbersBeforeItsEnd) {
  const FamilyState f = family("Out-Phase");
  EXPECT_EQ(line_of(f, "E", 160), "Out-Phase    153 orbits  T 30.0000  E 2.984322   K 447  period limit (T = 30)");
  EXPECT_EQ(line_of(f, "E", 71), "Out-Phase    153 orbits  T 30.0000  E 2.984322   period limit (T = 30)");
  EXPECT_EQ(line_of(f, "E", 60), "Out-Phase    153 orbits  T 30.0000  period limit (T = 30)");
  EXPECT_EQ(line_of(f, "E", 50), "Out-Phase    153 orbits period limit (T = 30)");
  EXPECT_EQ(line_of(f, "E", 30), "Out-Phase    153 orbits  perio");
}

TEST(Display, AFamilyWithoutAnEnergyHasNone) {
  FamilyState f = family("Out-Phase");
  f.level = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(line_of(f, "E", 160), "Out-Phase    153 orbits  T 30.0000  K 447  period limit (T = 30)");
}

TEST(Display, OfALongNameTheEndIsKept) {
  EXPECT_THAT(line_of(family("Out-Phase>1@6.148/0>2@5.98/0>3@7.5/1"), "E", 60),
              AllOf(StartsWith("..0>2@5.98/0>3@7.5/1   153 orbits"), HasSubstr("period limit (T = 30)")));
  EXPECT_THAT(line_of(family("\x1b[31mred"), "E", 160), StartsWith("\\x1b[31mred "));
}

TEST(Display, NoLineIsWiderThanItMayBe) {
  WholeState whole{.done = 1234, .known = 56789, .failed = 7, .orbits = 1234567, .orbits_a_second = 987.6};
  whole.seconds = 7384.0;
  whole.left = 98765.0;
  for (std::size_t width = 20; width < 160; ++width) {
    EXPECT_LE(line_of(family("Out-Phase>1@6.148/0>2@5.98/0"), "parameter", width).size(), width);
    EXPECT_LE(line_of(whole, width, false).size(), width);
    EXPECT_LE(text_of(whole, width).size(), width);
  }
}

TEST(Display, TheWholeSaysTasksOrbitsRateAndTime) {
  WholeState whole{.done = 30, .known = 40, .failed = 2, .orbits = 1200, .orbits_a_second = 55.25};
  whole.seconds = 130.0;
  EXPECT_EQ(text_of(whole, 160), "30 of 40 tasks, 2 failed, 1200 orbits, 55.2/s, 2 min 10 s");
  EXPECT_EQ(line_of(whole, 69, false), "[#######--] 30 of 40 tasks, 2 failed, 1200 orbits, 55.2/s, 2 min 10 s");
  EXPECT_EQ(line_of(whole, 60, false), text_of(whole, 60)) << "no room for a bar";
  EXPECT_EQ(text_of(whole, 40), "30 of 40 tasks, 2 failed, 1200 orbits");
  EXPECT_THAT(line_of(whole, 160, true), StartsWith("[\u2588"));
  whole.left = 43.0;
  EXPECT_THAT(text_of(whole, 160), EndsWith(", about 43 s left"));
  whole.at_most = true;
  whole.left = 4000.0;
  EXPECT_THAT(text_of(whole, 160), EndsWith(", stops within 66 min 40 s"));
  EXPECT_THAT(text_of({}, 160), AllOf(StartsWith("0 of 0 tasks"), Not(HasSubstr("/s"))));
}

// Of `verify`, whose tasks are all known and make no orbits.
TEST(Display, TasksAloneHaveNoOrbits) {
  WholeState whole{.done = 30, .known = 40, .orbits = std::nullopt, .seconds = 9.0, .left = 3.0};
  EXPECT_EQ(text_of(whole, 160), "30 of 40 tasks, 9 s, about 3 s left");
  testing::internal::CaptureStderr();
  {
    TaskCountDisplay display(Display::live);
    orbweaver::queue::TaskCounts counts;
    counts.done = 3;
    counts.waiting = 5;
    display.started({"verify 0 000000000000", 0, "verify", {}}, 0);
    display.tick(counts);
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_THAT(shown, AllOf(HasSubstr("3 of 8 tasks"), HasSubstr(" left"), Not(HasSubstr("orbits"))));
}

}  // namespace
}  // namespace display_test
