#include <algorithm>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/report/summary_text.hpp"

namespace summary_text_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

survey::Summary sample_summary() {
  survey::Summary summary;
  summary.families = {
      {"0000.0000", "In-Phase", "S@1/2 R@0", 35, 8.2094, 30.0, -2.9999, 2.99906644, "period limit (T = 30)", false},
      {"0001.0000", "A name of great length", "", 2, 5.25, 5.5, 1.0, 1.25, "failure (a NaN at node 3)", true}};
  summary.remarks = {"no small oscillations around the top"};
  summary.failed_tasks = {"A name of great length: failure (a NaN at node 3)"};
  summary.failures = 1;
  summary.orbits = 37;
  summary.crossings = 5;
  summary.seconds = 12.345;
  summary.peak_memory_mib = {48.4, 417.2};
  summary.atlas = "some/folder/atlas.h5";
  summary.archived = true;
  return summary;
}

TEST(SummaryText, SaysEverythingThatItKnows) {
  const std::string text = report::to_text(sample_summary());
  EXPECT_THAT(text, AllOf(HasSubstr("In-Phase"), HasSubstr("A name of great length"),
                          HasSubstr("8.209400 .. 30.000000"), HasSubstr("-2.99990000 ..  2.99906644"),
                          HasSubstr("period limit (T = 30)"), HasSubstr("failure (a NaN at node 3)")));
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("note: no small oscillations around the top\n"),
            HasSubstr("failed: A name of great length: failure (a NaN at node 3)\n"),
            HasSubstr("2 families, 5 crossings, 37 orbits, 1 failed, 12.35 s; peak memory per rank: 48 417 MiB\n"),
            HasSubstr("archive: some/folder/atlas.h5\n")));
}

TEST(SummaryText, SaysWhatDoesNotAddUpAndCountsWhatLimitsCut) {
  using survey::FindingKind;
  using survey::Severity;
  survey::Summary summary = sample_summary();
  EXPECT_THAT(
      report::to_text(summary),
      HasSubstr("findings: 0 contradictions, 0 undecided, 0 cut by limits (orbweaver show some/folder/atlas.h5"));
  summary.findings = {{Severity::contradiction, FindingKind::duplicate_curve, "A: the same orbits"},
                      {Severity::failure, FindingKind::failed_task, "B: said above"},
                      {Severity::undecided, FindingKind::unknown_family, "C: ends on a family"},
                      {Severity::cut, FindingKind::limited_end, "D: ends by the scene's limits"},
                      {Severity::cut, FindingKind::limited_end, "E: ends by the scene's limits"}};
  const std::string text = report::to_text(summary);
  EXPECT_THAT(text,
              AllOf(HasSubstr("contradiction: A: the same orbits\n"), HasSubstr("undecided: C: ends on a family\n"),
                    HasSubstr("findings: 1 contradictions, 1 undecided, 2 cut by limits")));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("B: said above")), Not(HasSubstr("D: ends"))));
  summary.archived = false;
  EXPECT_THAT(report::to_text(summary), Not(HasSubstr("findings:"))) << "the witness looks at archives";
}

TEST(SummaryText, WhatMattersComesFirst) {
  using survey::FindingKind;
  using survey::Severity;
  survey::Summary summary = sample_summary();
  summary.findings = {{Severity::undecided, FindingKind::unknown_family, "C: ends on a family"},
                      {Severity::contradiction, FindingKind::duplicate_curve, "A: the same orbits"}};
  summary.passed_over = {"dips passed over at the bottom: T = 6", "dips passed over at the top: T = 7"};
  const std::string text = report::to_text(summary);
  std::vector<std::size_t> places;
  for (const char* said :
       {"2 families, 5 crossings", "failed: A name", "findings: 1", "contradiction: A", "undecided: C",
        "note: no small", "passed over at 2 equilibria", "family  ", "In-Phase", "archive: "})
    places.push_back(text.find(said));
  EXPECT_THAT(places, ::testing::Each(::testing::Ne(std::string::npos)));
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end())) << text;
  EXPECT_EQ(places.front(), 0u);
  EXPECT_THAT(text, Not(HasSubstr("T = 6")));
  EXPECT_THAT(report::to_text(summary, report::Detail::all),
              AllOf(HasSubstr("note: dips passed over at the bottom: T = 6\n"), Not(HasSubstr("2 equilibria"))));
}

TEST(SummaryText, ManyNotesAreListedInPart) {
  survey::Summary summary = sample_summary();
  summary.remarks.assign(30, "again");
  EXPECT_THAT(report::to_text(summary), HasSubstr("note: again\n... and 18 more: --verbose\n"));
  EXPECT_THAT(report::to_text(summary, report::Detail::all), Not(HasSubstr("more: --verbose")));
}

TEST(SummaryText, UnitsMayMakeNumbersSmallOrLarge) {
  survey::Summary summary = sample_summary();
  summary.families[0].period_from = 6.18012e-06;
  summary.families[0].level_from = -1.25e-24;
  summary.families[1].level_to = 2.5e9;
  EXPECT_THAT(report::to_text(summary),
              AllOf(HasSubstr("6.180120e-06 .. 30.000000"), HasSubstr("-1.250000e-24 .. "), HasSubstr("2.500000e+09")));
}

TEST(SummaryText, ColumnsAlign) {
  std::string text = report::to_text(sample_summary());
  text.erase(0, text.find("family  "));
  const std::string head = text.substr(0, text.find('\n'));
  const std::string first = text.substr(head.size() + 1, text.find('\n', head.size() + 1) - head.size() - 1);
  EXPECT_EQ(head.find("ended by"), first.find("period limit"));
  EXPECT_EQ(head.find("orbits") + 6, first.find("35") + 2);
}

TEST(SummaryText, NothingFoundIsSaidToo) {
  const std::string text = report::to_text({});
  EXPECT_THAT(text, HasSubstr("0 families, 0 crossings, 0 orbits, 0 failed"));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("note:")), Not(HasSubstr("failed:"))));
}

TEST(SummaryText, FamiliesLeftOutByLimitsAreCounted) {
  survey::Summary summary = sample_summary();
  summary.families.push_back({"0002.0000", "Long-4", "", 0, 0.0, 0.0, 0.0, 0.0,
                              "period limit (left out: begins at T = 21, beyond 20)", false});
  EXPECT_THAT(report::to_text(summary),
              AllOf(HasSubstr("period limit (left out: begins at T = 21, beyond 20)\n"),
                    HasSubstr("3 families (1 of them left out by limits), 5 crossings, 37 orbits, 1 failed")));
}

TEST(SummaryText, ChildrenAreIndented) {
  survey::Summary summary = sample_summary();
  summary.families[1].depth = 2;
  EXPECT_THAT(report::to_text(summary), HasSubstr("\n    A name of great length"));
}

TEST(SummaryText, AnArchiveOfManyFamiliesIsListedInPart) {
  survey::Summary summary = sample_summary();
  summary.families.resize(100, summary.families[0]);
  EXPECT_THAT(report::to_text(summary), HasSubstr("... and 40 more: orbweaver show some/folder/atlas.h5 families\n"));
}

}  // namespace
}  // namespace summary_text_test
