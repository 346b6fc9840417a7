#include "orbweaver/report/sweep_report.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace sweep_report_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<report::EquilibriumReport>& reports() {
  static const auto made =
      report::sweep_report(scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml"));
  return made;
}

const report::ModeRow& mode(const std::string& name) {
  for (const auto& report : reports())
    for (const auto& row : report.modes)
      if (row.name == name) return row;
  throw std::runtime_error("no mode " + name);
}

void expect_close(double value, double expected, double relative, const std::string& what) {
  EXPECT_LT(std::abs(value / expected - 1.0), relative) << what << ": " << value << " against " << expected;
}

struct TableRow {
  const char* name;
  double period;       // exact
  double grid_period;  // the nearest on the paper's grid
  double paper;        // degrees: Table I of the paper
  double deviation;    // degrees: the same at the exact period
};

const TableRow table_one[] = {
    {"In-Phase", 2.0 * std::numbers::pi / std::sqrt(2.0 - std::sqrt(2.0)), 8.21, 1.76e-4, 5.7e-6},
    {"Out-Phase", 2.0 * std::numbers::pi / std::sqrt(2.0 + std::sqrt(2.0)), 3.40, 1.02e-3, 2.7e-4},
    {"Down-Up", 2.0 * std::numbers::pi / std::pow(2.0, 0.25), 5.28, 0.0982, 3.9e-4},
    {"Up-Down", 2.0 * std::numbers::pi / std::pow(2.0, 0.25), 5.28, 0.0976, 1.06e-3},
};

TEST(SweepReport, ReproducesTheTableOfThePaper) {
  for (const TableRow& row : table_one) {
    const report::ModeRow& found = mode(row.name);
    expect_close(found.period, row.period, 1e-9, row.name);
    EXPECT_NEAR(found.grid_period, row.grid_period, 1e-9) << row.name;
    expect_close(found.grid_deviation, row.paper, 0.02, row.name);
    expect_close(found.deviation, row.deviation, 0.05, row.name);
    EXPECT_EQ(found.isotropy, "S@1/2 R@0") << row.name;
  }
}

TEST(SweepReport, HasEveryEquilibriumAndNoOscillationAtTheTop) {
  ASSERT_EQ(reports().size(), 4U);
  EXPECT_EQ(reports()[0].modes.size(), 2U);
  EXPECT_EQ(reports()[3].modes.size(), 0U);
  const std::string text = report::to_text(reports());
  EXPECT_THAT(text,
              HasSubstr("\nth1 = 180 deg, th2 = 180 deg, w1 = 0, w2 = 0\n  no small oscillations for T in [1, 12]\n"));
  EXPECT_EQ(text.find("no small oscillations"), text.rfind("no small oscillations"));
}

TEST(SweepReport, TextNamesModesAndTheDipsPassedOver) {
  EXPECT_THAT(report::to_text(reports()),
              AllOf(HasSubstr("In-Phase"), HasSubstr("Out-Phase"), HasSubstr("Down-Up"), HasSubstr("Up-Down"),
                    HasSubstr("8.209377223816"),
                    HasSubstr("dip at T = 6.80087077: 2 times around the oscillation with T = 3.4004353847"),
                    HasSubstr("dip at T = 10.567016: 2 times around")));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(SweepReport, CsvKeepsEveryDigit) {
  const std::vector<std::string> lines = lines_of(report::eigenvalue_csv(reports()));
  ASSERT_EQ(lines.size(), 1102U);  // periods 1, 1.01, ..., 12
  EXPECT_THAT(lines[0], AllOf(HasSubstr("period,\"smallest eigenvalue at th1 = 0 deg, th2 = 0 deg, w1 = 0, w2 = 0\""),
                              HasSubstr("th1 = 180 deg, th2 = 180 deg")));
  for (std::size_t row = 0; row + 1 < lines.size(); ++row) {
    std::istringstream cells(lines[row + 1]);
    std::vector<double> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    ASSERT_EQ(values.size(), 5U) << lines[row + 1];
    EXPECT_EQ(values[0], reports()[0].sweep.table[row].period);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(values[n + 1], reports()[n].sweep.table[row].eigenvalue);
  }
}

TEST(SweepReport, EigenvaluesDipWhereFamiliesStart) {
  const auto& table = reports()[0].sweep.table;
  const auto at = [&](double period) {
    return table[static_cast<std::size_t>(std::lround((period - 1.0) / 0.01))].eigenvalue;
  };
  EXPECT_LT(at(8.21), 1e-3 * at(8.0));
  EXPECT_LT(at(3.40), 1e-3 * at(3.2));
}

TEST(SweepReport, TableHasALineAPeriod) {
  const std::vector<std::string> lines = lines_of(report::eigenvalue_table(reports()));
  ASSERT_EQ(lines.size(), 1102U);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("T"), HasSubstr("lambda_1"), HasSubstr("lambda_4")));
  for (const std::string& line : lines) EXPECT_EQ(line.size(), lines[0].size());
}

TEST(SweepReport, ModesOutsideTheRangeAreToldOfByName) {
  const auto report = report::sweep_report(
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml", {"starts.sweep.period=[3, 4]"}));
  ASSERT_EQ(report[0].modes.size(), 1U);
  EXPECT_EQ(report[0].modes[0].name, "Out-Phase");
  EXPECT_THAT(report::to_text(report),
              AllOf(HasSubstr("left out: In-Phase with T = 8.209377223816"), HasSubstr("outside the range [3, 4]"),
                    HasSubstr("left out: Down-Up with T = 5.28350800118")));
}

TEST(SweepReport, SaysHowStableAnEquilibriumIs) {
  const std::string text = report::to_text(reports());
  EXPECT_THAT(text, AllOf(HasSubstr("\n  elliptic\n"), HasSubstr("\n  unstable: eigenvalues 1.18921, -1.18921\n"),
                          HasSubstr("\n  unstable: eigenvalues 1.84776, 0.765367, -0.765367, -1.84776\n")));
}

TEST(SweepReport, AutomaticRangesHaveColumnsOfTheirOwnPeriods) {
  const auto report =
      report::sweep_report(scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum_half_degree.yaml"));
  const std::vector<std::string> lines = lines_of(report::eigenvalue_csv(report));
  ASSERT_EQ(lines.size(), 1002U);
  EXPECT_THAT(lines[0],
              AllOf(HasSubstr("\"period at th1 = 0 deg, th2 = 0 deg"), HasSubstr("\"period at th1 = 180 deg")));
  for (const std::string& line : lines_of(report::eigenvalue_table(report))) EXPECT_EQ(line.size(), 4 * 30U - 2U);
  std::istringstream cells(lines[1]);
  for (const report::EquilibriumReport& r : report) {
    std::string period;
    std::string value;
    std::getline(cells, period, ',');
    std::getline(cells, value, ',');
    EXPECT_EQ(std::stod(period), r.sweep.table[0].period);
    EXPECT_EQ(std::stod(value), r.sweep.table[0].eigenvalue);
  }
}

TEST(SweepReport, NoEquilibriumGivesHeadingsOnly) {
  EXPECT_EQ(lines_of(report::eigenvalue_csv({})).size(), 1U);
  EXPECT_EQ(lines_of(report::eigenvalue_table({})).size(), 1U);
}

// Two oscillations share one period: the directions in their common kernel are modes like the others.
TEST(SweepReport, ModesOfAResonance) {
  const auto report =
      report::sweep_report(scene::parse("name: henon-heiles\n"
                                        "system: {name: henon_heiles}\n"
                                        "starts:\n"
                                        "  fixed_points: {grid: [[0], [0]]}\n"
                                        "  sweep: {period: [6, 6.5], step: 0.05}\n",
                                        "henon_heiles.yaml"));
  ASSERT_EQ(report.size(), 1U);
  ASSERT_EQ(report[0].modes.size(), 3U);
  const char* isotropies[] = {"S@0 R@0", "S@1/2 R@0", "C@1/3 RS@0"};
  for (std::size_t n = 0; n < 3; ++n) {
    expect_close(report[0].modes[n].period, 2.0 * std::numbers::pi, 1e-12, isotropies[n]);
    EXPECT_EQ(report[0].modes[n].isotropy, isotropies[n]);
  }
  // y'' = y^2 - y along the axis of symmetry: frequency 1 - 5 a^2 / 12 at amplitude a, so that after 2 pi the momentum
  // is a 2 pi (5 a^2 / 12).
  const double a = 0.01;
  expect_close(report[0].modes[0].deviation, 2.0 * std::numbers::pi * 5.0 / 12.0 * a * a * a, 0.02, "deviation");
  EXPECT_THAT(report::to_text(report), AllOf(HasSubstr("start after a step of 0.01 along"), Not(HasSubstr("deg"))));
}

}  // namespace
}  // namespace sweep_report_test
