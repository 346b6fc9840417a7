#include "orbweaver/report/plot/plot.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "gnuplot.hpp"
#include "plot/figure.hpp"
#include "plot/label_places.hpp"

namespace plot_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;
using ::testing::Not;

/// What gnuplot, a shell, SVG or its markup might take for their own.
const std::string hostile =
    "x'; !touch hacked\nset output '|touch hacked' `touch hacked` {/=50 @m} <b>&amp; %s \"$data0_0";

archive::Archive sample() {
  const archive::Header header = test::sample_header();
  archive::Records records = test::sample_records(header);
  records.families[1].name = hostile;
  for (archive::CrossingRecord& crossing : records.crossings) crossing.energy = -2.0;
  return archive::Archive(test::write_sample_atlas(test::fresh_folder("plot"), header, records));
}

TEST(Plot, NamesAreQuotedAndNeverCommands) {
  const std::string script = report::plot_script(sample(), {"tree", {}, {}}, "picture.svg");
  EXPECT_THAT(script, HasSubstr("title " + report::gnuplot_text(hostile).substr(0, 18)));
  EXPECT_THAT(script, Not(HasSubstr("\nset output '|")));
  EXPECT_THAT(script, Not(HasSubstr("\n!")));
  EXPECT_EQ(report::gnuplot_text("it's\n\x1b"), "'it''s\\n\\x1b'");
}

TEST(Plot, GnuplotDrawsHostileNamesAsText) {
  const std::filesystem::path folder = test::fresh_folder("drawn");
  if (!report::run_gnuplot(folder, "nothing", "exit\n")) GTEST_SKIP() << "gnuplot is not installed (gnuplot-nox)";
  const std::filesystem::path picture = report::draw_plot(sample(), {"tree", {hostile}, {}}, folder);
  const std::string svg = (std::ostringstream() << std::ifstream(picture).rdbuf()).str();
  EXPECT_THAT(svg, HasSubstr("x'; !touch hacked"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  EXPECT_FALSE(std::filesystem::exists(folder / "hacked"));
  EXPECT_FALSE(std::filesystem::exists("hacked"));
}

TEST(Plot, SolidWhereStableAndMarksAtCrossings) {
  const std::string script = report::plot_script(sample(), {"tree", {"In-Phase"}, {}}, "picture.svg");
  EXPECT_THAT(script, HasSubstr("dashtype (8,5)"));  // indices above 2
  EXPECT_THAT(script, HasSubstr("title 'unstable'"));
  EXPECT_THAT(script, HasSubstr("title 'period doubling'"));
  EXPECT_THAT(script, Not(HasSubstr("title 'branch point'")));  // on another family
}

std::string error_of(const report::PlotRequest& request, const archive::Archive& atlas = sample()) {
  try {
    static_cast<void>(report::plot_script(atlas, request, "picture.svg"));
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// More families than there are colours, each the child of the one before, and the first of the last if it is a circle.
std::string script_of_chain(std::size_t length, bool is_circle) {
  const archive::Header header = test::sample_header();
  archive::Records records;
  const archive::Records whole = test::sample_records(header);
  for (std::size_t n = 0; n < length; ++n) {
    archive::FamilyRecord family = whole.families[0];
    family.key = fmt::format("{:06}", n);
    family.name = fmt::format("f{}", n);
    family.parent_key = n > 0 ? fmt::format("{:06}", n - 1) : is_circle ? fmt::format("{:06}", length - 1) : "";
    family.end_family_key.clear();
    family.crossing = family.end_crossing = -1;
    records.families.push_back(family);
    archive::OrbitRecord orbit = whole.orbits[0];
    orbit.family_key = family.key;
    records.orbits.push_back(orbit);
  }
  const archive::Archive atlas(test::write_sample_atlas(test::fresh_folder("chain"), header, records));
  return report::plot_script(atlas, {"tree", {}, {}}, "picture.svg");
}

TEST(Plot, ParentsInACircleHaveOneColour) {
  const std::string chain = script_of_chain(8, false);
  EXPECT_THAT(chain, HasSubstr("'f0'"));
  EXPECT_EQ(script_of_chain(8, true), chain);
}

TEST(Plot, OfASystemWithoutAnEnergyThePictureThatThereIsIsNamed) {
  archive::Header header = test::sample_header();
  header.scale_names.push_back("g");
  header.scales.push_back(1.0);
  archive::Records records = test::sample_records(header);
  for (archive::OrbitRecord& orbit : records.orbits) orbit.energy = archive::not_computed;
  const archive::Archive atlas(test::write_sample_atlas(test::fresh_folder("plot_no_energy"), header, records));
  EXPECT_THAT(error_of({"energy-period", {}, {}}, atlas), HasSubstr("`tree` draws the period against g"));
}

TEST(Plot, WhatCannotBeDrawnIsNamed) {
  EXPECT_THAT(error_of({"forest", {}, {}}), HasSubstr("expected one of tree, energy-period, "));
  EXPECT_THAT(error_of({"tree", {"Sideways"}, {}}), HasSubstr("no family `Sideways`"));
  EXPECT_THAT(error_of({"tree", {"Up-Down"}, {}}), HasSubstr("has no orbits to draw"));
  EXPECT_THAT(error_of({"off-branch", {}, {}}), HasSubstr("nothing to draw: no `off_branch_eigenvalue`"));
  EXPECT_THAT(error_of({"off-branch", {}, {}}), HasSubstr("set `survey.spectrum: all` in the scene"));
  EXPECT_THAT(error_of({"tree", {"In-Phase"}, 1}), HasSubstr("expected no --step for `tree`"));
  EXPECT_THAT(error_of({"orbit", {}, {}}), HasSubstr("expected one --family for `orbit`"));
  EXPECT_THAT(error_of({"spectrum", {"In-Phase"}, 99}), HasSubstr("and no step 99"));
  EXPECT_THAT(error_of({"birth", {"In-Phase"}, {}}), HasSubstr("`In-Phase` of "));
  EXPECT_THAT(error_of({"birth", {"In-Phase"}, {}}), HasSubstr("was born at no crossing"));
  EXPECT_THAT(error_of({"accuracy", {}, {}}), HasSubstr("expected one --family for `accuracy`"));
  EXPECT_THAT(error_of({"convergence", {}, {}}), HasSubstr("expected one --family for `convergence`"));
  EXPECT_EQ(report::plot_format_of("a/b.pdf"), report::PlotFormat::pdf);
  EXPECT_THROW(static_cast<void>(report::plot_format_of("b.gif")), core::InputError);
}

TEST(LabelPlaces, NamesOverlapNeitherEachOtherNorTheFrame) {
  std::vector<report::NamedCurve> curves;
  for (int n = 0; n < 12; ++n) {
    report::NamedCurve curve{"family " + std::to_string(n), "#000000", {}};
    for (int i = 0; i <= 20; ++i) curve.points.push_back({i / 20.0, 0.3 + 0.02 * n + 0.2 * i / 20.0});
    curves.push_back(curve);
  }
  const report::CharacterSize size{0.015, 0.05};
  const std::vector<report::PlotLabel> labels = report::label_places(curves, {}, size);
  EXPECT_GE(labels.size(), 2U);
  for (const report::PlotLabel& a : labels) {
    const double width = size.width * static_cast<double>(a.text.size());
    EXPECT_GE(a.u, 0.0);
    EXPECT_LE(a.u + width, 1.0);
    EXPECT_GE(a.v - 0.5 * size.height, 0.0);
    EXPECT_LE(a.v + 0.5 * size.height, 1.0);
    for (const report::PlotLabel& b : labels) {
      if (&a == &b) continue;
      const double other = size.width * static_cast<double>(b.text.size());
      EXPECT_TRUE(a.u >= b.u + other || b.u >= a.u + width || std::abs(a.v - b.v) >= size.height)
          << a.text << " and " << b.text;
    }
  }
}

TEST(Figure, ScalesAndTheirTics) {
  EXPECT_DOUBLE_EQ(report::placed(report::Scale::logarithmic, 1e-3), -3.0);
  EXPECT_TRUE(std::isnan(report::placed(report::Scale::logarithmic, 0.0)));
  EXPECT_DOUBLE_EQ(report::placed(report::Scale::squeezed, 2.0 * std::sinh(3.0)), 3.0);
  report::Figure figure{"", {"k"}, {"modulus", report::Scale::logarithmic}};
  figure.series.push_back({"q", report::Look::marks, "#000000", {{1.0, 1.0}, {2.0, 0.0}, {3.0, 1e-4}}});
  const std::string script =
      report::figure_script({figure}, report::PlotStyle::paper, report::PlotFormat::pdf, "picture.pdf");
  EXPECT_THAT(script, HasSubstr("'10⁻²' -2"));
  EXPECT_THAT(script, HasSubstr("1 0\n\n3 -4\n"));  // nothing at 0, and a gap
}

TEST(Figure, ALegendHasTheLinesThatItsLongestEntryAsksFor) {
  report::Figure figure{"", {"x"}, {"y"}};
  for (int n = 0; n < 6; ++n)
    figure.series.push_back({"T = 1", report::Look::solid, "#000000", {{0.0, 0.0}, {1.0, 1.0 + n}}});
  const auto lines = [&](report::PlotStyle style) {
    const std::string script = report::figure_script({figure, figure}, style, report::PlotFormat::svg, "picture.svg");
    const std::string before = "vertical maxrows ";
    return script.at(script.find(before) + before.size());
  };
  EXPECT_EQ(lines(report::PlotStyle::paper), '2');
  EXPECT_EQ(lines(report::PlotStyle::wide), '1');
  figure.series.front().key = "a name of thirty-one characters";
  EXPECT_EQ(lines(report::PlotStyle::paper), '6');
  EXPECT_EQ(lines(report::PlotStyle::wide), '2');
}

}  // namespace
}  // namespace plot_test
