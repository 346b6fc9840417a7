#include "orbweaver/numerics/extended.hpp"

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::numerics::extended_test {
namespace {

TEST(Extended, HasTheWorkingDigits) {
  const WorkingDigits outer(30);
  const Extended third = Extended(1) / 3;
  {
    const WorkingDigits inner(80);
    EXPECT_GE((Extended(1) / 3).precision(), 80U);
    EXPECT_NEAR(log10_abs(rounded(third) - Extended(1) / 3), -31.0, 1.5);
    Extended wide = Extended(1) / 3;
    const WorkingDigits narrow(20);
    add_to(wide, Extended(1));
    add_to(wide, Extended(-1));
    const WorkingDigits again(80);
    EXPECT_LT(log10_abs(wide - Extended(1) / 3), -78.0);  // it keeps its digits
  }
  EXPECT_TRUE(Extended(1) / 3 == third);
}

TEST(Extended, ReadsDecimalNumbers) {
  const WorkingDigits working(50);
  EXPECT_TRUE(extended_of("9") == 9);
  EXPECT_TRUE(extended_of("-1.25e-3") == Extended(-5) / 4000);
  EXPECT_TRUE(extended_of("+.5") == Extended(1) / 2);
  EXPECT_LT(log10_abs(extended_of("0.1") - Extended(1) / 10), -50.0);
  for (const char* wrong : {"", "nine", "1,5", "0x10", "1e", "--1", "inf", "nan", "1 ", "."})
    EXPECT_THROW(static_cast<void>(extended_of(wrong)), core::InputError) << wrong;
  EXPECT_EQ(shortest_decimal(0.1), "0.1");
  EXPECT_EQ(shortest_decimal(1.0 / 3.0), "0.3333333333333333");
}

TEST(Extended, IsPrintedRounded) {
  const WorkingDigits working(50);
  EXPECT_EQ(decimal_text(extended_of("1.23456"), 4), "1.235");
  EXPECT_EQ(decimal_text(extended_of("-123.456"), 5), "-123.46");
  EXPECT_EQ(decimal_text(extended_of("0.00123456"), 3), "0.00123");
  EXPECT_EQ(decimal_text(extended_of("0.000123456"), 3), "1.23e-4");
  EXPECT_EQ(decimal_text(extended_of("-2.5e17"), 3), "-2.50e17");
  EXPECT_EQ(decimal_text(extended_of("99999"), 3), "1.00e5");
  EXPECT_EQ(decimal_text(Extended(0), 3), "0");
}

}  // namespace
}  // namespace orbweaver::numerics::extended_test
