#include "orbweaver/report/cost/cost_report.hpp"

#include <gmock/gmock.h>

namespace cost_report_test {
namespace {

using namespace orbweaver;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

cost::Table sample() {
  return {"ladder",
          "A family: error against time",
          {{"orbit"}, {"solver"}, {"time per orbit", "s"}, {"error"}},
          {{"middle", "one", 0.25, 1e-3},
           {"middle", "two, or \"so\"", 1.0 / 3.0, 0.0},
           {"middle", "one", 0.5, 1e-5},
           {"end", "one", {}, 2.0}},
          {"A remark."},
          cost::Plot{2, 3, {1}, 0}};
}

TEST(CostReport, CsvHasUnitsAllDigitsAndQuotes) {
  EXPECT_EQ(report::table_csv(sample()),
            "orbit,solver,time_per_orbit_s,error\n"
            "middle,one,0.25,0.001\n"
            "middle,\"two, or \"\"so\"\"\",0.3333333333333333,0\n"
            "middle,one,0.5,1e-05\n"
            "end,one,,2\n");
}

TEST(CostReport, TextHasADashWhereNothingIs) {
  const std::string text = report::table_text(sample());
  EXPECT_THAT(text, HasSubstr("A family: error against time\n"));
  EXPECT_THAT(text, HasSubstr("time per orbit [s]"));
  EXPECT_THAT(text, HasSubstr("1.00e-03"));
  EXPECT_THAT(text, HasSubstr("A remark."));
  EXPECT_THAT(text, ::testing::ContainsRegex("end +one +- +2"));
}

TEST(CostReport, APictureForEachPanelWithTheNumbersThatHaveAPlaceOnLogarithmicAxes) {
  const auto pictures = report::pictures_of(sample(), report::PlotFormat::svg);
  ASSERT_EQ(pictures.size(), 1U);  // the end has no time
  EXPECT_EQ(pictures[0].name, "ladder_middle");
  const std::string& script = pictures[0].script;
  EXPECT_THAT(script, HasSubstr("set output 'ladder_middle.svg'"));
  EXPECT_THAT(script, HasSubstr("set xlabel 'time per orbit [s]'"));
  EXPECT_THAT(script, HasSubstr("set ylabel 'error'"));
  EXPECT_THAT(script, HasSubstr("0.25 0.001\n0.5 1e-05\n"));
  EXPECT_THAT(script, Not(HasSubstr("two, or")));  // its only error is 0
  cost::Table without = sample();
  without.plot.reset();
  EXPECT_TRUE(report::pictures_of(without, report::PlotFormat::pdf).empty());
}

}  // namespace
}  // namespace cost_report_test
