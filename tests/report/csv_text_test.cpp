#include "csv_text.hpp"

#include <gmock/gmock.h>

#include <string>

namespace csv_text_test {
namespace {

using orbweaver::report::csv_text;

TEST(CsvText, IsAsItIsWhereItMayBe) {
  for (const char* text : {"", "In-Phase", "a = 1", "T' = 2", "-1", "+2.5e-3", "-inf", "θ1"})
    EXPECT_EQ(csv_text(text), text);
}

TEST(CsvText, IsInQuotesWhereItWouldEndAField) {
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("a\"b\n=1+1"), "\"a\"\"b\n=1+1\"");
}

TEST(CsvText, IsNoFormulaOfASpreadsheet) {
  for (const std::string text :
       {"=1+1", "=cmd|' /C calc'!A0", "+1+1", "-1+1", "-x", "@SUM(1)", "\t=1+1", "\r=1+1", "=", "+"})
    EXPECT_EQ(csv_text(text), "\"'" + text + "\"");
  EXPECT_EQ(csv_text("=HYPERLINK(\"http://x\",1)"), "\"'=HYPERLINK(\"\"http://x\"\",1)\"");
}

}  // namespace
}  // namespace csv_text_test
