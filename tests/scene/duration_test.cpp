#include "duration.hpp"

#include <string>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"

namespace duration_test {
namespace {

using namespace orbweaver;
using drivers::seconds_of;

TEST(Duration, IsReadAsBatchSystemsWriteIt) {
  EXPECT_EQ(seconds_of("5400"), 5400.0);
  EXPECT_EQ(seconds_of("90:00"), 5400.0);
  EXPECT_EQ(seconds_of("1:30:00"), 5400.0);
  EXPECT_EQ(seconds_of("0:0.25"), 0.25);
  EXPECT_EQ(seconds_of("000001:000002:000000003.5"), 3723.5);
  EXPECT_EQ(seconds_of("5."), 5.0);
  EXPECT_EQ(seconds_of("0.1"), 0.1);
  EXPECT_EQ(seconds_of("999999999"), 999999999.0);
}

TEST(Duration, RefusesEverythingElse) {
  for (const char* text : {"",     "0",     "0:00", "0.000", ":",          "1:",         ":1",  "1::2", "1:2:3:4",
                           "-1",   "+1",    " 1",   "1 ",    "1e3",        "1.5:00",     "inf", "nan",  ".5",
                           "1..2", "1.2.3", "1,5",  "0x10",  "1234567:00", "1234567890", "1h",  "1.5s"})
    EXPECT_THROW((void)seconds_of(text), core::InputError) << text;
  EXPECT_THROW((void)seconds_of(std::string("1\0", 2)), core::InputError);
}

}  // namespace
}  // namespace duration_test
