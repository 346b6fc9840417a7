#include <gmock/gmock.h>

#include <sstream>

#include "archive/sample.hpp"
#include "orbweaver/archive/show.hpp"
#include "orbweaver/core/error.hpp"

namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
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
            "name,parent,crossing,multiplicity,isotropy,first_orbit,orbit_count,end_reason,end_family,end_crossing");
  EXPECT_EQ(lines[2], "ID1,0,1,1,S@1/2 R@0,12,3,the period reached the scene's limit,-1,-1");
  EXPECT_EQ(lines[5], "\"Ästhetik \"\"B\"\", 1\",3,2,2,S@1/2 R@0,24,5,the period reached the scene's limit,1,0");
}

TEST(Show, OrbitsAsCsvSpreadTheirVectorsAndKeepEveryDigit) {
  Header header = test::sample_header();
  Records records = test::sample_records(header);
  records.orbits[9].energy = 0.1;
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("orbits_csv"), header, records));
  const auto lines = lines_of(shown(atlas, "orbits", TextFormat::csv));
  ASSERT_EQ(lines.size(), 30u);
  EXPECT_EQ(lines[0],
            "family,step,arclength,period,energy,action,parameter,cutoff,loss_rms,off_branch_eigenvalue,stability_0,"
            "fundamental_stability_0,stability_error,state_θ1,state_w1,closure,single_shot,energy_drift,tail,"
            "modes_begin,modes_count,time_map_begin,time_map_count,winding_n1");
  EXPECT_EQ(
      lines[1],
      "0,0,0,3.125,0.10000000000000001,0.28125,nan,2,9.9999999999999994e-12,nan,9,9.5,nan,900,-900.015625,nan,nan,"
      "nan,0.0087890625,0,10,0,5,0");
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
      "\"state\": [1000, -1000.015625], \"closure\": null, \"single_shot\": null, \"energy_drift\": null, "
      "\"tail\": 0.009765625, \"modes_begin\": 10, \"modes_count\": 14, \"time_map_begin\": 5, "
      "\"time_map_count\": 0, \"winding\": [0]},");
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

TEST(Show, FamiliesReadablyWithNamesForIndices) {
  const Archive atlas = sample_atlas("readable", test::sample_header());
  const auto lines = lines_of(shown(atlas, "families", TextFormat::readable));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0],
            "name             parent     times around  isotropy   orbits          period              energy  end");
  EXPECT_EQ(lines[3],
            "Up-Down          -                     1  S@1/2 R@0       0               -                   -  "
            "no first orbit could be found – the Newton iteration stalled");
  EXPECT_EQ(lines[5],
            "Ästhetik \"B\", 1  Out-Phase             2  S@1/2 R@0       5  4.625 .. 5.125  -1.6875 .. -1.4375  "
            "the period reached the scene's limit");
  EXPECT_THAT(shown(atlas, "crossings", TextFormat::readable), HasSubstr("period-doubling"));
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
