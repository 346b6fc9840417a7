#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/report/show.hpp"

namespace show_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using namespace orbweaver::report;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Archive sample_atlas(const std::string& folder, const Header& header) {
  return Archive(test::write_sample_atlas(test::fresh_folder(folder), header, test::sample_records(header)));
}

std::string shown(const Archive& atlas, const std::string& name, TextFormat format) {
  std::ostringstream out;
  print_table(out, atlas, name, format);
  return out.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Show, FamiliesAsCsv) {
  const Archive atlas = sample_atlas("families_csv", test::sample_header());
  const auto lines = lines_of(shown(atlas, "families", TextFormat::csv));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0],
            "name,parent,crossing,multiplicity,isotropy,first_orbit,orbit_count,end_reason,end_family,end_crossing,"
            "birth_arclength");
  EXPECT_EQ(lines[2], "ID1,0,1,1,S@1/2 R@0,12,3,the period reached the scene's limit,-1,-1,nan");
  EXPECT_EQ(lines[5], "\"Ästhetik \"\"B\"\", 1\",3,2,2,S@1/2 R@0,24,5,the period reached the scene's limit,1,0,nan");
}

std::string selected(const Archive& atlas, const std::string& name, TextFormat format, const Selection& selection) {
  std::ostringstream out;
  print_table(out, atlas, name, format, selection);
  return out.str();
}

TEST(Show, RowsOfAFamilyInChosenColumnsAndOrder) {
  const Archive atlas = sample_atlas("selection", test::sample_header());
  ASSERT_EQ(atlas.families().texts("name")[1], "ID1");
  const std::vector<std::int64_t>& families = atlas.orbits().integers("family");
  const auto first = static_cast<std::size_t>(std::find(families.begin(), families.end(), 1) - families.begin());
  const double period = atlas.orbits().reals("period")[first];
  const auto lines =
      lines_of(selected(atlas, "orbits", TextFormat::csv, {"ID1", {"step", "state_w1", "family"}, "-step"}));
  ASSERT_EQ(lines.size(), 4U);  // of 29 orbits
  EXPECT_EQ(lines[0], "step,state_w1,family");
  EXPECT_THAT(lines[1], testing::StartsWith("2,"));
  EXPECT_THAT(lines[3], testing::AllOf(testing::StartsWith("0,"), testing::EndsWith(",1")));
  EXPECT_EQ(lines_of(selected(atlas, "orbits", TextFormat::json, {"ID1", {"period"}, "step"}))[1],
            fmt::format("  {{\"period\": {}}},", period));
  const auto readable = lines_of(selected(atlas, "orbits", TextFormat::readable, {"ID1", {"family", "step"}, ""}));
  EXPECT_THAT(readable, ElementsAre("family  step", "ID1        0", "ID1        1", "ID1        2"));
  EXPECT_EQ(lines_of(selected(atlas, "families", TextFormat::csv, {"ID1", {"name"}, ""})).size(), 2U);
}

TEST(Show, TheParameterThatMovesIsAColumnByItsOwnName) {
  Header header = test::sample_header();
  header.scale_names = {"time", header.state_names[0], header.state_names[1], header.parameter_names[0]};
  header.scales = {1.0, 1.0, 1.0, 1.0};
  const Archive atlas = sample_atlas("moving", header);
  const std::string& name = header.parameter_names[0];
  const auto lines = lines_of(selected(atlas, "crossings", TextFormat::csv, {"", {name}, "-" + name}));
  EXPECT_EQ(lines[0], "parameter");
  EXPECT_EQ(lines[1], lines_of(selected(atlas, "crossings", TextFormat::csv, {"", {"parameter"}, "-parameter"}))[1]);
}

TEST(Show, SelectionsOfWhatIsNotThereAreRefused) {
  const Archive atlas = sample_atlas("no_selection", test::sample_header());
  const auto message = [&](const std::string& table, const Selection& selection) -> std::string {
    try {
      (void)selected(atlas, table, TextFormat::csv, selection);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("orbits", {"Nobody", {}, ""}), HasSubstr("no family `Nobody`"));
  EXPECT_THAT(message("orbits", {"", {"periode"}, ""}), HasSubstr("no column `periode`: orbits has family, step"));
  EXPECT_THAT(message("orbits", {"", {}, "state"}), HasSubstr("cannot sort by `state`, which has 2 values"));
  EXPECT_THAT(message("findings", {"ID1", {}, "-nothing"}), HasSubstr("no column `nothing`"));
}

TEST(Show, OrbitsAsCsvSpreadTheirVectorsAndKeepEveryDigit) {
  Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.orbits[9].energy = 0.1;
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("orbits_csv"), header, records));
  const auto lines = lines_of(shown(atlas, "orbits", TextFormat::csv));
  ASSERT_EQ(lines.size(), 30u);
  EXPECT_EQ(
      lines[0],
      "family,step,arclength,period,energy,action,parameter,cutoff,loss_rms,off_branch_eigenvalue,stability_0,"
      "fundamental_stability_0,stability_error,log_volume,state_θ1,state_w1,closure,single_shot,energy_drift,tail,"
      "modes_begin,modes_count,time_map_begin,time_map_count,winding_n1,verdict,taylor_closure,"
      "integrators_apart,other_drift,symmetry_defect,recurrence,orbit_distance,contraction,pairing,index_gap");
  EXPECT_EQ(
      lines[1],
      "0,0,0,3.125,0.10000000000000001,0.28125,nan,2,9.9999999999999994e-12,nan,9,9.5,nan,nan,900,-900.015625,nan,nan,"
      "nan,0.0087890625,0,10,0,5,0,-1,nan,nan,nan,nan,nan,nan,nan,nan,nan");
}

TEST(Show, OrbitsAsJson) {
  const Archive atlas = sample_atlas("orbits_json", test::sample_header(1, false));
  const std::string text = shown(atlas, "orbits", TextFormat::json);
  const auto lines = lines_of(text);
  ASSERT_EQ(lines.size(), 31u);
  EXPECT_EQ(lines.front(), "[");
  EXPECT_EQ(lines.back(), "]");
  EXPECT_EQ(
      lines[2],
      "  {\"family\": 0, \"step\": 1, \"arclength\": 0.25, \"period\": 3.25, \"energy\": -2.375, \"action\": 0.3125, "
      "\"parameter\": null, \"cutoff\": 3, \"loss_rms\": 9.9999999999999994e-12, \"off_branch_eigenvalue\": null, "
      "\"stability\": [[10, -10.015625]], \"fundamental_stability\": [[null, null]], \"stability_error\": null, "
      "\"log_volume\": null, \"state\": [1000, -1000.015625], \"closure\": null, \"single_shot\": null, "
      "\"energy_drift\": null, "
      "\"tail\": 0.009765625, \"modes_begin\": 10, \"modes_count\": 14, \"time_map_begin\": 5, "
      "\"time_map_count\": 0, \"winding\": [0], \"verdict\": -1, \"taylor_closure\": null, "
      "\"integrators_apart\": null, \"other_drift\": null, \"symmetry_defect\": null, \"recurrence\": null, "
      "\"orbit_distance\": null, "
      "\"contraction\": null, \"pairing\": null, \"index_gap\": null},");
}

TEST(Show, TextsAreEscapedInJson) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.families[0].end_reason = "line one\nback\\slash";
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("escapes"), header, records));
  const std::string text = shown(atlas, "families", TextFormat::json);
  EXPECT_THAT(text, HasSubstr("\"name\": \"Ästhetik \\\"B\\\", 1\""));
  EXPECT_THAT(text, HasSubstr("\"line one\\u000aback\\\\slash\""));
}

TEST(Show, FamiliesReadablyAsATree) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.crossings[1].multiplicity = 2;
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("readable"), header, records));
  EXPECT_EQ(shown(atlas, "families", TextFormat::readable),
            R"(family             born at                     orbits          period              energy  stability
In-Phase           -                               12    3.125 .. 4.5    -2.4375 .. -1.75  --==========
    S@1/2 R@0; unstable; ended: the period reached the scene's limit
  ID1              period-doubling T 6.5, m 1       3     5.25 .. 5.5     -1.375 .. -1.25  ===
      S@1/2 R@0; unstable; ended: the period reached the scene's limit
Up-Down            -                                0               -                   -
    S@1/2 R@0; ended: no first orbit could be found – the Newton iteration stalled
Out-Phase          -                                9          2 .. 3          -3 .. -2.5  ___:-----
    S@1/2 R@0; stable T 2 .. 2.25; ended: the period reached the scene's limit
  Ästhetik "B", 1  branch-point T 5.5, m 2          5  4.625 .. 5.125  -1.6875 .. -1.4375  =====
      S@1/2 R@0; unstable; ended: the period reached the scene's limit -> ID1 at fold-energy T 4.5
)");
}

std::string families_for(const Archive& atlas, const Layout& layout) {
  std::ostringstream out;
  print_table(out, atlas, "families", TextFormat::readable, {}, layout);
  return out.str();
}

TEST(Show, NarrowLinesHaveBirthAndStabilityBeforeTheDetails) {
  const Archive atlas = sample_atlas("narrow", test::sample_header());
  const std::string text = families_for(atlas, {.width = 76});
  for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), 77U) << line;  // one letter has two bytes
  EXPECT_THAT(text, HasSubstr("\n  ID1              "));
  EXPECT_THAT(text, HasSubstr("\n      === period-doubling T 6.5, m 1; S@1/2 R@0; unstable; ended: the period"));
}

TEST(Show, StabilityIsDrawnByTheLargestMultiplier) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.crossings.clear();
  records.families = {records.families[1]};
  records.sections.clear();
  const std::vector<double> multipliers{1.5, 2.5, 5.0, 50.0, 500.0, 5000.0, 50000.0};
  records.orbits.resize(multipliers.size() + 2);
  for (std::size_t i = 0; i < multipliers.size(); ++i)
    records.orbits[i].stability = {(i % 2 == 0 ? 1 : -1) * (multipliers[i] + 1.0 / multipliers[i])};
  records.orbits[7].stability = {1.0};
  records.orbits[8].stability = {not_computed};
  for (OrbitRecord& orbit : records.orbits) orbit.stability_error = 1e-9;
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("drawn"), header, records));
  EXPECT_THAT(families_for(atlas, {}), HasSubstr("  .:-=+*#_?\n"));
  EXPECT_THAT(families_for(atlas, {.unicode = true}),
              HasSubstr("  \u2582\u2583\u2584\u2585\u2586\u2587\u2588\u2581?\n"));
}

TEST(Show, TheHeadHasTheSystemItsParametersAndUnits) {
  Header header = test::sample_header();
  std::ostringstream unknown;
  print_table_head(unknown, sample_atlas("head_unknown", header));
  EXPECT_EQ(unknown.str(),
            "made_up, with friction\nparameters   m = 0.1, g = 9.81\n"
            "units        θ1 in radians, times, energies and states in the units of the parameters\n\n");
  Records records = test::sample_records(header);
  for (OrbitRecord& orbit : records.orbits) orbit.energy = not_computed;
  std::ostringstream without_energy;
  print_table_head(without_energy, Archive(test::write_sample_atlas(test::fresh_folder("head_nan"), header, records)));
  EXPECT_THAT(without_energy.str(),
              HasSubstr("units        θ1 in radians, times and states in the units of the parameters"));
  header.system = "double_pendulum";
  header.effects = {"damping"};
  header.parameter_names = {"c1", "c2", "g", "l1", "l2", "m1", "m2"};
  header.parameter_values = {0.25, 0.5, 9.81, 1, 1, 1, 2};
  std::ostringstream known;
  print_table_head(known, Archive(test::write_sample_atlas(test::fresh_folder("head_known"), header, {})),
                   {.width = 60});
  EXPECT_THAT(known.str(),
              HasSubstr("double_pendulum: Double pendulum, with damping\nparameters   c1 = 0.25 N m s/rad, c2 "
                        "= 0.5 N m s/rad,\n             g = 9.81 m/s^2, l1 = 1 m,"));
}

/// A curve of `points` equilibria from step 0 on, stable up to `stable`, and one equilibrium beside it.
Records with_equilibria(int points, int stable) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  const std::size_t d = header.state_names.size();
  for (int step = 0; step < points; ++step) {
    EquilibriumRecord& point = records.equilibria.emplace_back();
    point.step = step;
    point.arclength = 0.1 * step;
    point.kind = "equilibrium";
    point.parameter = step;
    point.state.assign(d, 0.0);
    point.stability = step <= stable ? "stable" : "unstable";
  }
  EquilibriumRecord& other = records.equilibria.emplace_back(records.equilibria.front());
  other.equilibrium = 1;
  return records;
}

/// The steps of the rows that are shown, and what is said behind them.
std::pair<std::vector<int>, std::string> shown_equilibria(const std::string& folder, const Records& records,
                                                          const Selection& selection = {}) {
  const Archive atlas(test::write_sample_atlas(test::fresh_folder(folder), test::sample_header(), records));
  std::vector<int> steps;
  std::string behind;
  for (const std::string& line : lines_of(selected(atlas, "equilibria", TextFormat::readable, selection))) {
    int number = 0;
    int step = 0;
    if (line.find("left out") != std::string::npos)
      behind = line;
    else if (std::sscanf(line.c_str(), "%d %d", &number, &step) == 2)
      steps.push_back(step);
  }
  return {steps, behind};
}

TEST(Show, EquilibriaOfACurveAreThoseAtWhichSomethingIs) {
  Records records = with_equilibria(40, 40);
  records.equilibria[7].kind = "hopf";
  records.equilibria[21].kind = "fold-parameter";
  records.equilibria[30].kind = "a kind that comes later";
  records.equilibria[33].note = "why it ends";
  const auto [steps, behind] = shown_equilibria("equilibria", records);
  EXPECT_THAT(steps, ElementsAre(0, 7, 21, 30, 33, 39, 0));
  EXPECT_THAT(behind, testing::AllOf(HasSubstr("34 of 41 points are left out"), HasSubstr("--all")));
}

TEST(Show, EquilibriaWhoseStabilityChangesWithoutAReasonAreShown) {
  Records records = with_equilibria(40, 11);
  EXPECT_THAT(shown_equilibria("stability_changes", records).first, ElementsAre(0, 11, 12, 39, 0));
  records.equilibria[12].kind = "hopf";  // which says it
  EXPECT_THAT(shown_equilibria("stability_at_hopf", records).first, ElementsAre(0, 12, 39, 0));
}

TEST(Show, AllEquilibriaWhereTheyAreAskedForAndNothingIsSaidBehindThem) {
  const Records records = with_equilibria(40, 40);
  const auto [steps, behind] = shown_equilibria("all_equilibria", records, {.all_equilibria = true});
  EXPECT_EQ(steps.size(), 41U);
  EXPECT_EQ(behind, "");
  const auto [few, nothing] = shown_equilibria("few_equilibria", with_equilibria(2, 2));
  EXPECT_THAT(few, ElementsAre(0, 1, 0));
  EXPECT_EQ(nothing, "");
}

TEST(Show, EquilibriaInAnOrderOfTheirOwnAreTheSameOnes) {
  Records records = with_equilibria(40, 40);
  records.equilibria[7].kind = "hopf";
  EXPECT_THAT(shown_equilibria("sorted_equilibria", records, {.sort = "-parameter"}).first, ElementsAre(39, 7, 0, 0));
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("equilibria_json"), test::sample_header(), records));
  EXPECT_EQ(lines_of(shown(atlas, "equilibria", TextFormat::csv)).size(), 42U);  // with the head
  EXPECT_EQ(lines_of(shown(atlas, "equilibria", TextFormat::json)).size(), 43U);
}

TEST(Show, FindingsALineEach) {
  const Header header = test::sample_header();
  const auto folder = test::fresh_folder("findings");
  test::write_sample_atlas(folder, header, test::sample_records(header));
  const auto witness = [](const std::filesystem::path&) {
    return std::optional(std::vector<FindingRecord>{
        {"contradiction", "index-change", 0, -1, -1, 2.0, -1.0, not_computed, 0.25, "In-Phase: a multiplier passes"},
        {"cut", "limited-end", 1, -1, -1, not_computed, not_computed, not_computed, not_computed, "ID1: ends"}});
  };
  archive::consolidate(MPI_COMM_SELF, {folder / "segment.h5"}, folder / "said.h5", header,
                       test::tables_of(test::sample_records(header)), {}, witness);
  const Archive atlas(folder / "said.h5");
  EXPECT_EQ(shown(atlas, "findings", TextFormat::readable),
            "contradiction  index-change           2.5e-01  In-Phase: a multiplier passes\n"
            "cut            limited-end                  -  ID1: ends\n");
  EXPECT_THAT(lines_of(shown(atlas, "findings", TextFormat::csv))[1],
              "contradiction,index-change,0,-1,-1,2,-1,nan,0.25,"
              "In-Phase: a multiplier passes");
}

TEST(Show, CrossingsReadablyWithTheFamiliesBornAndEndingThere) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.families[0].crossing = 0;
  records.crossings[0].energy = -1.25;
  records.crossings[0].sector_j = 1;
  records.crossings[0].sector_q = 4;
  records.crossings[0].multiplicity = 2;
  records.crossings[0].residual = -3.5e-12;
  records.crossings[0].test_value = -2;
  records.crossings[0].place_error = 1.5e-3;
  records.crossings[0].place_error_energy = 2.5e-4;
  records.crossings[2].kernel_dimension = -1;
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("crossings"), header, records));
  const std::string head =
      "row  family     period  energy  kind             m  q  j  kernel  place error  in energy  residual  test value "
      " ";
  const std::string of_two =
      "  2  Out-Phase     5.5       -  branch-point     1  1  0       2            -          -         -           -"
      "  ";
  EXPECT_EQ(shown(atlas, "crossings", TextFormat::readable),
            head + R"(born there            end there
  0  In-Phase      4.5       -  fold-energy      1  1  0       -            -          -         -           -  )" +
                R"(-                     Ästhetik "B", 1
  1  In-Phase      6.5   -1.25  period-doubling  2  4  1       2  )" +
                R"(    1.5e-03    2.5e-04  -3.5e-12          -2  ID1, Ästhetik "B", 1  -
)" + of_two + "-                     -\n");
  std::ostringstream out;
  print_table(out, atlas, "crossings", TextFormat::readable, {.family = "Out-Phase"});
  EXPECT_EQ(out.str(), head + "born there            end there\n" + of_two + "-                     -\n");
}

TEST(Show, AnEndThatNamesTheFamilyIsNotToldTwice) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.families[0].end_reason = "joined ID1 at T = 4.5";
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("joined"), header, records));
  EXPECT_THAT(shown(atlas, "families", TextFormat::readable), HasSubstr("ended: joined ID1 at T = 4.5\n"));
}

TEST(Show, LinesOfTheTreeStayWithin120Characters) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  for (int n = 0; n < 200; ++n) records.families[2].end_reason += fmt::format(", and reason {}", n);
  records.families[3].name = std::string(80, 'n');
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("long"), header, records));
  const std::string text = shown(atlas, "families", TextFormat::readable);
  for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), 121U) << line;  // one letter has two bytes
  EXPECT_THAT(text, HasSubstr("\n    reason 2,"));
  EXPECT_THAT(text, HasSubstr("...\n  ID1 "));
  EXPECT_THAT(text, HasSubstr("nnnnn... "));
  EXPECT_THAT(shown(atlas, "families", TextFormat::csv), HasSubstr("and reason 199"));
}

std::vector<std::string> family_column(const Archive& atlas) {
  std::vector<std::string> names;
  for (const std::string& line : lines_of(shown(atlas, "families", TextFormat::readable)))
    if (line.find("ended:") == std::string::npos)
      names.push_back(line.substr(0, line.find("  ", line.find_first_not_of(' '))));
  return names;
}

TEST(Show, ChildrenStandBehindTheirParentWhateverTheOrderOfKeys) {
  const Header header = test::sample_header();
  Records records;
  const auto add = [&](const char* key, const char* name, const char* parent) {
    FamilyRecord family;
    family.key = key;
    family.name = name;
    family.parent_key = parent;
    family.end_reason = "-";
    records.families.push_back(family);
  };
  add("1", "one", "");
  add("1+", "other side", "");
  add("1.1", "child", "1");
  add("1.1.1", "grandchild", "1.1");
  add("1.2", "second child", "1");
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("order"), header, records));
  EXPECT_THAT(family_column(atlas),
              ElementsAre("family", "one", "  child", "    grandchild", "  second child", "other side"));
  records.families[0].parent_key = "1.1";  // in a circle
  const Archive circle(test::write_sample_atlas(test::fresh_folder("circle"), header, records));
  EXPECT_THAT(family_column(circle),
              ElementsAre("family", "other side", "one", "  child", "    grandchild", "  second child"));
}

TEST(Show, ALongChainOfParentsTakesALineEach) {
  const Header header = test::sample_header();
  constexpr int length = 20000;  // lines of 2 n columns would be 400 MB
  Records records;
  for (int n = 0; n < length; ++n) {
    FamilyRecord family;
    family.key = fmt::format("{:06}", n);
    family.name = fmt::format("f{}", n);
    if (n > 0) family.parent_key = fmt::format("{:06}", n - 1);
    family.end_reason.assign(1, '-');
    records.families.push_back(family);
  }
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("chain"), header, records));
  const std::string text = shown(atlas, "families", TextFormat::readable);
  EXPECT_LT(text.size(), std::size_t{length} * 200);
  EXPECT_THAT(text, HasSubstr("\n                        f19999 "));
}

TEST(Show, Summary) {
  const Archive atlas = sample_atlas("summary", test::sample_header());
  std::ostringstream out;
  print_summary(out, atlas);
  EXPECT_THAT(out.str(), HasSubstr("written by Orbweaver 0.1.0"));
  EXPECT_THAT(out.str(), HasSubstr("coordinates  θ1, w1\nfamilies     5\norbits       29\ncrossings    3\n"));
  EXPECT_THAT(out.str(), HasSubstr("period       2 .. 5.5\n"));
  EXPECT_THAT(out.str(), HasSubstr("\nOut-Phase "));
}

TEST(Show, AnEmptyAtlasIsShownToo) {
  const Header header = test::sample_header();
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("empty"), header, {}));
  EXPECT_EQ(shown(atlas, "orbits", TextFormat::json), "[]\n");
  EXPECT_EQ(lines_of(shown(atlas, "crossings", TextFormat::csv)).size(), 1u);
  std::ostringstream out;
  print_summary(out, atlas);
  EXPECT_THAT(out.str(), HasSubstr("orbits       0\n"));
  EXPECT_THAT(out.str(), HasSubstr("period       -\n"));
}

TEST(Show, AnUnknownTableIsTheUsersError) {
  const Archive atlas = sample_atlas("unknown", test::sample_header());
  EXPECT_THROW(static_cast<void>(shown(atlas, "modes", TextFormat::csv)), core::InputError);
}

}  // namespace
}  // namespace show_test
