#include "orbweaver/core/text.hpp"

#include <string>

#include <gtest/gtest.h>

namespace text_test {
namespace {

using namespace orbweaver::core;
using namespace std::string_literals;

TEST(Text, OfEveryLengthOfACharacterIsTextual) {
  EXPECT_EQ(first_untextual("a\t\n \xC3\xBC \xE2\x82\xAC \xF0\x9D\x84\x9E \xED\x9F\xBF \xEE\x80\x80 \xF4\x8F\xBF\xBF"),
            std::string::npos);
  EXPECT_EQ(first_untextual(""), std::string::npos);
}

// RFC 3629, sections 3, 4 and 10.
TEST(Text, WhatIsNoCharacterIsFoundWhereItBegins) {
  for (const std::string& bad : {"\xFF"s, "\x80"s, "\xC0\xAF"s, "\xC1\xBF"s, "\xE0\x80\xAF"s, "\xE0\x9F\xBF"s,
                                 "\xED\xA0\x80"s, "\xF0\x8F\xBF\xBF"s, "\xF4\x90\x80\x80"s, "\xF5\x80\x80\x80"s,
                                 "\xC3"s, "\xE2\x82"s, "\xE2\x28\xA1"s, "\xF0\x9D\x84"s, "\0"s})
    EXPECT_EQ(first_untextual("\xC3\xBC" + bad + "a"), 2U) << printable(bad);
}

TEST(Printable, EscapesControlCharactersAndBytes) {
  EXPECT_EQ(printable("a\x1b[31m\n\r\t\x7f\0b"s), "a\\x1b[31m\\n\\r\\t\\x7f\\x00b");
  EXPECT_EQ(printable("\xC2\x9B \xFF\xC3\xBC"), "\\xc2\\x9b \\xff\xC3\xBC");
  EXPECT_EQ(printable("a\xE2\x80\xAE"
                      "b\xE2\x81\xA6\xE2\x80\xA8\xD8\x9C\xE2\x82\xAC\xE2\x80\x93"),
            "a\\xe2\\x80\\xaeb\\xe2\\x81\\xa6\\xe2\\x80\\xa8\\xd8\\x9c\xE2\x82\xAC\xE2\x80\x93");
  EXPECT_EQ(printable_lines("a\x1b\n\tb\r"), "a\\x1b\n\tb\\r");
}

TEST(Recordable, IsPrintableAndOfBoundedLength) {
  EXPECT_EQ(recordable("Kr\xF6mmung\n"), "Kr\\xf6mmung\n");
  const std::string longest = recordable(std::string(10'000, '\x1b'));
  EXPECT_LE(longest.size(), 2000U);
  EXPECT_EQ(recordable(longest), longest);
}

TEST(CodePoint, OfEveryLength) {
  EXPECT_EQ(code_point("A"), U'A');
  EXPECT_EQ(code_point("\xC3\xBC"), U'\u00FC');
  EXPECT_EQ(code_point("\xE2\x82\xAC"), U'\u20AC');
  EXPECT_EQ(code_point("\xF0\x9D\x84\x9E"), U'\U0001D11E');
}

TEST(Shortened, EndsAtAWholeCharacter) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abc...");
  EXPECT_EQ(shortened("ab\xE2\x82\xAC\xE2\x82\xAC", 7), "ab...");
  EXPECT_EQ(shortened("ab\xE2\x82\xAC\xE2\x82\xAC", 8), "ab\xE2\x82\xAC\xE2\x82\xAC");
}

}  // namespace
}  // namespace text_test
