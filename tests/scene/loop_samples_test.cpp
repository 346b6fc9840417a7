#include "orbweaver/scene/loop_samples.hpp"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::scene::loop_samples_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Eight samples of a loop of period 4, with one line changed to `line` (1: the header); 0: none.
std::string table(int changed = 0, const std::string& line = "") {
  std::string text;
  for (int n = 1; n <= 9; ++n) {
    const std::string usual = n == 1 ? "w2,t, th2,th1,w1" : fmt::format("{},{},2,3,4", n, 0.5 * (n - 2));
    text += (n == changed ? line : usual) + "\n";
  }
  return text;
}

LoopSamples read(const std::string& text, double period = 4.0) {
  return parse_loop_samples(text, "loop.csv", *systems::make_system("double_pendulum"), period);
}

std::string refusal(const std::string& text, double period = 4.0) {
  try {
    static_cast<void>(read(text, period));
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LoopSamples, AreReadInAnyOrderOfColumns) {
  const LoopSamples samples = read(table());
  ASSERT_EQ(samples.times.size(), 8U);
  EXPECT_EQ(samples.times[3], 1.5);
  EXPECT_THAT(samples.states[3], ElementsAre(3.0, 2.0, 4.0, 5.0));
  EXPECT_EQ(read(table(9, "9,4,2,3,4\r")).times.back(), 4.0) << "a last row that closes the loop";
}

TEST(LoopSamples, AreRefusedWithFileAndLine) {
  EXPECT_EQ(refusal(table(5, "5,nan,2,3,4")),
            "loop.csv:5: expected a number of modulus 1e+100 at most, got `nan`; correct it");
  EXPECT_THAT(refusal(table(5, "5,1.5,2,1e300,4")), HasSubstr("loop.csv:5: expected a number"));
  EXPECT_EQ(refusal(table(5, "5,0.9,2,3,4")), "loop.csv:5: expected a time after 1, got 0.9; sort the rows by t");
  EXPECT_EQ(refusal(table(5, "5,1.0000000001,2,3,4")),
            "loop.csv:5: expected a time more than 4e-09 after 1, got 1.0000000001; leave one of the two rows out");
  EXPECT_THAT(refusal(table(2, "5,-1e16,2,3,4")), HasSubstr("loop.csv:2: expected a time of 1e+06 periods at most"));
  EXPECT_THAT(refusal(table(5, "5,1.5,2,3")), HasSubstr("loop.csv:5: expected 5 numbers, one a column, got 4"));
  EXPECT_THAT(refusal(table(5, "")), HasSubstr("loop.csv:5: expected 5 numbers, one a column, got 1"));
  EXPECT_THAT(refusal(table(1, "t,th1,th2,w1")),
              HasSubstr("loop.csv:1: expected a first line with the columns t, th1, th2, w1, w2, got no w2"));
  EXPECT_THAT(refusal(table(1, "t,th1,th2,w1,w1")), HasSubstr("got `w1` twice"));
  EXPECT_THAT(refusal(table(1, "t,th1,th2,w1,w3")), HasSubstr("got `w3`"));
  EXPECT_THAT(refusal(table().substr(0, 60)), HasSubstr("loop.csv:"));
  EXPECT_THAT(refusal("t,th1,th2,w1,w2\n0,0,0,0,0\n1,0,0,0,0\n"),
              HasSubstr("loop.csv:3: expected at least 8 rows, got 2"));
  EXPECT_THAT(refusal(table(), 3.0),
              HasSubstr("loop.csv:9: expected times within one period, 3, from the first, 0, got 3.5"));
  EXPECT_THAT(refusal(table(), 9.0), HasSubstr("loop.csv:9: expected samples around the whole loop"));
  EXPECT_THAT(refusal(table(7, "7,2.5,2,\xFF,4")), HasSubstr("loop.csv:7: expected UTF-8"));
  EXPECT_THAT(refusal(""), HasSubstr("loop.csv:1: expected a table in CSV, got an empty file"));
}

}  // namespace
}  // namespace orbweaver::scene::loop_samples_test
