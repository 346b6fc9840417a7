#include "orbweaver/report/export/export_orbits.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <sstream>

#include "archive/sample.hpp"
#include "orbweaver/report/export/auto_restart.hpp"

namespace export_test {
namespace {

using namespace orbweaver;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Lines = std::vector<std::vector<std::string>>;

/// RFC 4180, read as another program would.
Lines fields_of(const std::string& csv) {
  Lines lines{{""}};
  bool is_quoted = false;
  for (std::size_t at = 0; at < csv.size(); ++at) {
    const char c = csv[at];
    if (is_quoted && c == '"' && at + 1 < csv.size() && csv[at + 1] == '"') {
      lines.back().back() += c;
      ++at;
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (!is_quoted && c == ',') {
      lines.back().emplace_back();
    } else if (!is_quoted && c == '\n') {
      lines.push_back({""});
    } else {
      lines.back().back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

const std::string hostile = "a,\"b\"\n=1+1, 'c'";

class Export : public ::testing::Test {
 protected:
  Export() {
    archive::Records records = test::sample_records(header);
    records.families[1].name = hostile;  // Out-Phase
    records.orbits[3].period = 1.0 / 3.0;
    records.orbits[3].state[0] = 0.1 + 0.2;
    atlas = std::make_unique<archive::Archive>(test::write_sample_atlas(test::fresh_folder("export"), header, records));
  }
  std::string csv(const report::ExportSelection& selection = {}) const {
    std::ostringstream out;
    report::export_csv(out, *atlas, selection);
    return out.str();
  }
  std::string json(const report::ExportSelection& selection = {}) const {
    std::ostringstream out;
    report::export_json(out, *atlas, selection);
    return out.str();
  }
  archive::Header header = test::sample_header();
  std::unique_ptr<archive::Archive> atlas;
};

TEST_F(Export, CsvHasALineAnOrbitWithEveryBit) {
  const Lines lines = fields_of(csv());
  EXPECT_THAT(lines.front(), ElementsAre("family", "step", "period", "energy", "parameter_m", "parameter_g",
                                         "linear_stability", "stability_0", "state_θ1", "state_w1"));
  ASSERT_EQ(lines.size(), 1 + atlas->orbits().rows());
  for (std::size_t row = 0; row < atlas->orbits().rows(); ++row) {
    const std::vector<std::string>& line = lines[row + 1];
    ASSERT_EQ(line.size(), lines.front().size());
    const auto family = static_cast<std::size_t>(atlas->orbits().integers("family")[row]);
    EXPECT_EQ(line[0], atlas->families().texts("name")[family]);
    EXPECT_EQ(std::stol(line[1]), atlas->orbits().integers("step")[row]);
    const auto same = [&](std::size_t field, double value) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(std::stod(line[field])), std::bit_cast<std::uint64_t>(value))
          << lines.front()[field] << " of row " << row;
    };
    same(2, atlas->orbits().reals("period")[row]);
    same(3, atlas->orbits().reals("energy")[row]);
    same(4, 0.1);
    same(5, 9.81);
    same(7, atlas->orbits().reals("stability")[row]);
    same(8, atlas->orbits().reals("state")[2 * row]);
    same(9, atlas->orbits().reals("state")[2 * row + 1]);
  }
}

TEST_F(Export, NamesAreData) {
  const Lines lines = fields_of(csv({hostile, {}}));
  ASSERT_EQ(lines.size(), 10U);
  for (std::size_t n = 1; n < lines.size(); ++n) EXPECT_EQ(lines[n][0], hostile);
  EXPECT_THAT(json({hostile, {}}), HasSubstr(R"("family": "a,\"b\"\u000a=1+1, 'c'")"));
}

TEST_F(Export, OneStepOfAFamily) {
  const Lines lines = fields_of(csv({hostile, -3}));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1][1], "-3");
  const std::string text = json({hostile, -1});
  EXPECT_THAT(text, HasSubstr("\"period\": 0.33333333333333331, "));
  EXPECT_THAT(text, HasSubstr("\"parameters\": {\"m\": 0.10000000000000001, \"g\": 9.8100000000000005}"));
  EXPECT_THAT(text, HasSubstr("\"state\": [0.30000000000000004, "));
  EXPECT_THAT(text, HasSubstr("\"stability_values\": \"indices\""));
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(Export, WhatIsNotThereIsNamed) {
  EXPECT_THAT(error_of([&] { csv({"Sideways", {}}); }), HasSubstr("no family `Sideways`"));
  EXPECT_THAT(error_of([&] { csv({hostile, 99}); }), HasSubstr("has the steps -4 to 4, and no step 99"));
  EXPECT_THAT(error_of([&] { csv({"", 1}); }), HasSubstr("expected --family"));
  EXPECT_THAT(error_of([&] { csv({"Up-Down", {}}); }), HasSubstr("has no orbits: no first orbit could be found"));
  std::ostringstream out;
  EXPECT_THAT(error_of([&] { report::export_auto(out, *atlas, {}); }), HasSubstr("expected --family"));
  const archive::Archive empty(test::write_sample_atlas(test::fresh_folder("empty"), header, {}));
  EXPECT_THAT(error_of([&] { report::export_json(out, empty, {}); }), HasSubstr("has no orbits"));
}

TEST_F(Export, AutoGetsNoOrbitsThatTurnOver) {
  archive::Records records = test::sample_records(header);
  for (archive::OrbitRecord& orbit : records.orbits) orbit.winding = {orbit.step == 2 ? -1.0 : 0.0};
  const archive::Archive turning(test::write_sample_atlas(test::fresh_folder("turning"), header, records));
  std::ostringstream out;
  EXPECT_THAT(error_of([&] {
                report::export_auto(out, turning, {"In-Phase", {}});
              }),
              HasSubstr("step 2 turns over (n1 = -1)"));
  EXPECT_EQ(out.str(), "");
}

TEST(AutoParameters, LeaveOutThoseThatAutoKeeps) {
  EXPECT_EQ(report::auto_parameter(0), 1);
  EXPECT_EQ(report::auto_parameter(8), 9);
  EXPECT_EQ(report::auto_parameter(9), 13);
}

}  // namespace
}  // namespace export_test
