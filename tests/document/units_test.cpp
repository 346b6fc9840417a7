#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/document/units.hpp"

namespace units_test {
namespace {

using namespace orbweaver::document;
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Units, NumbersAreWholeScalars) {
  EXPECT_EQ(parse_number("30"), 30.0);
  EXPECT_EQ(parse_number("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number(".inf"), infinity);
  EXPECT_EQ(parse_number("+.Inf"), infinity);
  EXPECT_EQ(parse_number("-.INF"), -infinity);
  for (const char* text :
       {"", "+", "-", "+-1", "1 ", "1x", "0x10", "inf", "nan", ".nan", "1e999", "1,5", "--.inf", "1e"})
    EXPECT_FALSE(parse_number(text).has_value()) << text;
}

TEST(Units, IntegersHaveNoFraction) {
  EXPECT_EQ(parse_integer("4096"), 4096);
  EXPECT_EQ(parse_integer("-1"), -1);
  EXPECT_EQ(parse_integer("+7"), 7);
  for (const char* text : {"", "2.5", "5.0", "1e3", "3000000000", "0x10", "one"})
    EXPECT_FALSE(parse_integer(text).has_value()) << text;
}

TEST(Units, AnglesNeedAUnit) {
  EXPECT_EQ(parse_angle("180deg"), std::numbers::pi);
  EXPECT_EQ(parse_angle("0.01rad"), 0.01);
  EXPECT_EQ(parse_angle("1e-8rad"), 1e-8);
  for (const char* text : {"", "deg", "0.5", "0.5 deg", "0.5grad", "0.5degrees", "xdeg"})
    EXPECT_FALSE(parse_angle(text).has_value()) << text;
}

TEST(Units, RightAnglesAreExact) {
  EXPECT_EQ(radians(180), std::numbers::pi);
  EXPECT_EQ(radians(-90), -std::numbers::pi / 2);
  EXPECT_EQ(radians(360), 2 * std::numbers::pi);
  EXPECT_EQ(degrees(std::numbers::pi), 180.0);
}

}  // namespace
}  // namespace units_test
