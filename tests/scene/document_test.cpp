#include "orbweaver/document/document.hpp"

#include <ctime>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/scene.hpp"

namespace document_test {
namespace {

namespace document = orbweaver::document;
namespace scene = orbweaver::scene;
using namespace std::string_literals;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(document::parse_document(text, "text.yaml", true));
  } catch (const orbweaver::core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string whole;
  for (std::size_t n = 0; n < count; ++n) whole += text;
  return whole;
}

TEST(Document, AStrayCommaIsRefusedAndMakesNoDocumentsForEver) {
  for (const std::string text : {",", ", a: 1", "[1, 2],", ",,,"})
    EXPECT_THAT(refusal(text), HasSubstr("text.yaml:")) << text;
  EXPECT_EQ(refusal("[1,2],"),
            "text.yaml:1: expected one YAML document, got a second; remove the `---` between them, or the comma that "
            "stands outside of brackets");
}

TEST(Document, OneDocumentMayHaveItsMarks) {
  EXPECT_EQ(document::parse_document("---\na: 1\n...\n", "text.yaml", true)["a"].Scalar(), "1");
  EXPECT_TRUE(document::parse_document("# a comment\n", "text.yaml", true).IsNull());
  EXPECT_TRUE(document::parse_document("", "text.yaml", true).IsNull());
}

TEST(Document, NodesAreCountedThroughAliases) {
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int n = 1; n < 20; ++n) bomb += fmt::format("a{0}: &a{0} [*a{1}, *a{1}]\n", n, n - 1);
  EXPECT_THAT(refusal(bomb), HasSubstr("expected at most 20000 values"));
  EXPECT_EQ(refusal(fmt::format("[{}]", repeated("1,", document::most_nodes - 1))), "accepted");
  EXPECT_THAT(refusal(fmt::format("[{}]", repeated("1,", document::most_nodes))),
              HasSubstr("expected at most 20000 values"));
}

TEST(Document, LevelsAreCountedThroughAliases) {
  const std::size_t most = document::most_levels;
  EXPECT_EQ(refusal(repeated("[", most) + repeated("]", most)), "accepted");
  EXPECT_THAT(refusal(repeated("[", most + 1) + repeated("]", most + 1)), HasSubstr("at most 32 lists or maps"));
  std::string chain = "[&a0 []";
  for (std::size_t n = 1; n < most; ++n) chain += fmt::format(", &a{} [*a{}]", n, n - 1);
  EXPECT_THAT(refusal(chain + "]"), HasSubstr("at most 32 lists or maps"));
}

TEST(Document, AnAliasForWhatItStandsInIsRefused) {
  EXPECT_THAT(refusal("a: 1\nb: &b [1, *b]\n"), HasSubstr("text.yaml:2: expected a value, got an alias"));
}

TEST(Document, BytesThatAreNoTextAreRefusedWithTheirLine) {
  EXPECT_THAT(refusal("a: 1\nb: \xFF\n"), HasSubstr("text.yaml:2: expected a scene, text in UTF-8, got the byte 0xff"));
  EXPECT_THAT(refusal("a: 1\n\n# \xED\xA0\x80\n"), HasSubstr("text.yaml:3: "));
  EXPECT_THAT(refusal("a: \0 1"s), HasSubstr("text.yaml:1: expected a scene, text in UTF-8, got the byte 0x00"));
}

/// Of the processor: how busy the machine is does not matter.
double seconds_of(const std::function<void()>& body) {
  const std::clock_t start = std::clock();
  body();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// What is quadratic in the length takes minutes here, what is linear milliseconds (a second or two under sanitizers).
constexpr double enough = 5.0;  // seconds

TEST(Document, TheLengthIsLookedAtFirst) {
  const std::string text = fmt::format("[{}]", repeated("1,", 3000000));
  EXPECT_LT(seconds_of([&] { EXPECT_THAT(refusal(text), HasSubstr("expected at most 60000")); }), enough);
}

TEST(Document, TheLongestScenesTakeLittleTime) {
  std::string values, names, keys;
  for (int n = 1; n < 8000; ++n) values += fmt::format("{},", n);
  for (int n = 1; n < 900; ++n) names += fmt::format("[0, {0}e-3]: [F{0}], ", n);
  for (int n = 1; n < 5000; ++n) keys += fmt::format("k{}: 1\n", n);
  const auto parsed = [](const std::string& text) {
    try {
      return scene::parse(text, "long.yaml").events.periods.size();
    } catch (const orbweaver::core::InputError&) {
      return std::size_t{0};
    }
  };
  const std::string begin = "system: {name: double_pendulum}\n";
  EXPECT_LT(seconds_of([&] {
              EXPECT_EQ(parsed(begin + fmt::format("starts: {{}}\nevents: {{periods: [{}]}}\n", values)), 7999U);
            }),
            enough);
  EXPECT_LT(
      seconds_of([&] { parsed(begin + fmt::format("starts: {{fixed_points: {{grid: [[{}], [0]]}}}}\n", values)); }),
      enough);
  EXPECT_LT(seconds_of([&] { parsed(begin + fmt::format("starts: {{fixed_points: {{names: {{{}}}}}}}\n", names)); }),
            enough);
  EXPECT_LT(seconds_of([&] { EXPECT_EQ(parsed(begin + keys), 0U); }), enough);
  EXPECT_LT(seconds_of([&] { EXPECT_EQ(parsed(fmt::format("{}: 1\n", repeated("x", 59000))), 0U); }),
            enough);
}

}  // namespace
}  // namespace document_test
