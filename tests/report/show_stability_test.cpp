#include "show_stability.hpp"

#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "archive/sample.hpp"
#include "orbweaver/report/show.hpp"

namespace show_stability_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using namespace orbweaver::report;
using ::testing::HasSubstr;

// Intervals run along the family: where T turns in one, the turn stands between its ends.
TEST(ShowStability, IntervalsNameTheTurnsOfThePeriod) {
  const Header header = test::sample_header();
  const auto text = [&](const std::vector<double>& periods, const std::vector<double>& indices,
                        std::optional<double> fold = std::nullopt) {
    Records records = test::sample_records(header);
    const CrossingRecord some = records.crossings[1];
    records.crossings.clear();
    records.families = {records.families[1]};
    records.families[0].crossing = records.families[0].end_crossing = -1;
    records.orbits.assign(periods.size(), records.orbits[0]);
    records.sections.clear();
    for (std::size_t i = 0; i < periods.size(); ++i) {
      records.orbits[i].family_key = records.families[0].key;
      records.orbits[i].step = static_cast<int>(i);
      records.orbits[i].arclength = static_cast<double>(i);
      records.orbits[i].period = periods[i];
      records.orbits[i].stability = {indices[i]};
      records.orbits[i].stability_error = 1e-9;
    }
    if (fold) {
      records.crossings = {some};
      records.crossings[0].family_key = records.families[0].key;
      records.crossings[0].arclength = 1.75;
      records.crossings[0].period = *fold;
      records.crossings[0].kind = CrossingKind::fold_period;
    }
    const Archive atlas(test::write_sample_atlas(test::fresh_folder("turns"), header, records));
    return stability_text(atlas, 0);
  };
  EXPECT_EQ(text({25.2693, 25.28, 25.2999, 25.27, 25.2621, 25}, {1, 1, 1, 1, 1, 3}),
            "stable T 25.2693 .. 25.2999 .. 25.2621 (steps 0 to 4)");
  EXPECT_EQ(text({25.2693, 25.28, 25.2999, 25.27, 25.2621, 25}, {1, 1, 1, 1, 1, 3}, 25.3001),
            "stable T 25.2693 .. 25.3001 .. 25.2621 (steps 0 to 4)");
  EXPECT_EQ(text({1, 2, 2, 1.5, 3, 9}, {1, 1, 1, 1, 1, 3}), "stable T 1 .. 2 .. 1.5 .. 3 (steps 0 to 4)");
  EXPECT_EQ(text({1, 2, 3, 4, 5, 6}, {1, 1, 1, 1, 1, 3}), "stable T 1 .. 5");
  EXPECT_EQ(text({1, 3, 2, 4, 3, 5, 4, 9}, {1, 1, 1, 1, 1, 1, 1, 3}),
            "stable T 1 .. 4 (within 1 .. 5, turning 5 times) (steps 0 to 6)");
  // T does not turn where the orbits are stable, but there are others with the same T.
  EXPECT_EQ(text({1, 2, 3, 2.5, 2, 1.5}, {1, 1, 3, 3, 1, 1}),
            "stable T 1 .. 2 (steps 0 to 1), 2 .. 1.5 (steps 4 to 5)");
  EXPECT_EQ(text({2, 2, 2, 2}, {1, 1, 3, 3}), "stable T 2 (steps 0 to 1)");
  // What six digits do not show is no turn.
  EXPECT_EQ(text({1, 2, 2 - 1e-8, 3, 4}, {1, 1, 1, 1, 3}), "stable T 1 .. 3");
}

// Under a drive of one frequency T is the same all along.
TEST(ShowStability, WhereThePeriodIsOneNumberTheParameterTells) {
  Header header = test::sample_header();
  header.scale_names = {"time", "th1", "th2", "w1", "w2", "energy", "m"};
  header.scales.assign(header.scale_names.size(), 1.0);
  Records records = test::sample_records(header);
  records.crossings.clear();
  records.families = {records.families[1]};
  records.families[0].crossing = records.families[0].end_crossing = -1;
  records.orbits.assign(4, records.orbits[0]);
  records.sections.clear();
  for (std::size_t i = 0; i < records.orbits.size(); ++i) {
    records.orbits[i].family_key = records.families[0].key;
    records.orbits[i].step = static_cast<int>(i);
    records.orbits[i].arclength = static_cast<double>(i);
    records.orbits[i].period = 2.0;
    records.orbits[i].parameter = 1.0 + 0.5 * static_cast<double>(i);
    records.orbits[i].stability = {i < 3 ? 1.0 : 3.0};
    records.orbits[i].stability_error = 1e-9;
  }
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("one_period"), header, records));
  EXPECT_EQ(stability_text(atlas, 0), "stable m 1 .. 2");
}

// Below the least double a single multiplier is not known, but its logarithm is.
TEST(ShowStability, ASingleMultiplierOutOfRangeIsToldByTheVolume) {
  const Header header = test::sample_header(1, false);
  const auto text = [&](double log_volume) {
    Records records = test::sample_records(header);
    for (OrbitRecord& orbit : records.orbits) {
      orbit.energy = not_computed;
      orbit.stability = {not_computed, not_computed};
      orbit.stability_error = not_computed;
      orbit.log_volume = log_volume;
    }
    return stability_text(Archive(test::write_sample_atlas(test::fresh_folder("volume"), header, records)), 1);
  };
  EXPECT_EQ(text(-2500.0), "stable");
  EXPECT_EQ(text(2500.0), "unstable");
  EXPECT_EQ(text(-1e-9), "");
  EXPECT_EQ(text(not_computed), "");
}

std::string families_of(const Archive& atlas) {
  std::ostringstream out;
  print_table(out, atlas, "families", TextFormat::readable);
  return out.str();
}

// The one family of five orbits with T = 1 ... 5, these stabilities, and this error bound.
std::string stability_of(const Header& header, const std::vector<std::vector<double>>& values, double error) {
  Records records = test::sample_records(header);
  records.crossings.clear();
  records.families = {records.families[1]};
  records.orbits.resize(values.size());
  records.sections.clear();
  for (std::size_t i = 0; i < values.size(); ++i) {
    records.orbits[i].period = static_cast<double>(i + 1);
    records.orbits[i].stability = values[i];
    records.orbits[i].stability_error = error;
  }
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("stability"), header, records));
  std::istringstream lines(families_of(atlas));
  std::string line;
  for (int n = 0; n < 3; ++n) std::getline(lines, line);
  const std::size_t begin = line.find("; ") + 2;
  return line.substr(begin, line.find("ended:") - begin);
}

TEST(ShowStability, OfOnePairInIntervalsOfThePeriod) {
  const Header one = test::sample_header();
  const double nan = not_computed;
  EXPECT_EQ(stability_of(one, {{1}, {-1.5}, {2.5}, {0}, {-3}}, 1e-9), "stable T 1 .. 2, 4; ");
  EXPECT_EQ(stability_of(one, {{3}, {1}, {nan}, {1}, {1.9}}, 1e-9), "stable T 2, 4 .. 5; ");
  EXPECT_EQ(stability_of(one, {{1}, {-1.9}, {1.9}, {0}, {1}}, 1e-9), "stable; ");
  EXPECT_EQ(stability_of(one, {{1}, {-2}, {2}, {0}, {1}}, 1e-9), "stable T 1, 4 .. 5; ") << "open on the border";
  EXPECT_EQ(stability_of(one, {{3}, {-9}, {4}, {nan}, {7}}, nan), "unstable; ");
  EXPECT_EQ(stability_of(one, {{2 + 1e-7}, {-2 - 1e-7}, {2 - 1e-7}, {1}, {4}}, 1e-6), "stable T 4; ");
  EXPECT_EQ(stability_of(one, {{2 + 1e-7}, {-2 - 1e-7}, {2.1}, {3}, {4}}, 1e-8), "unstable; ");
  EXPECT_EQ(stability_of(one, {{1}, {1}, {1}, {1}, {1}}, 1), "") << "errors too large to tell";
}

TEST(ShowStability, ChangesAtLocatedCrossings) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  const CrossingRecord some = records.crossings[1];  // of Out-Phase, whose steps are a quarter in arclength
  records.crossings.clear();
  for (const auto& [arclength, period, kind] :
       {std::tuple(-0.45, 2.26, CrossingKind::subharmonic), std::tuple(-0.4, 2.27, CrossingKind::branch_point),
        std::tuple(0.9, 2.9, CrossingKind::krein)}) {
    records.crossings.push_back(some);
    records.crossings.back().arclength = arclength;
    records.crossings.back().period = period;
    records.crossings.back().kind = kind;
  }
  records.crossings.push_back(records.crossings.back());
  records.crossings.back().family_key = "0001";
  records.crossings.back().period = 9;
  for (FamilyRecord& family : records.families) family.crossing = family.end_crossing = -1;
  records.orbits[8].stability = {0.5};  // the last of Out-Phase, T = 3
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("located"), header, records));
  EXPECT_THAT(families_of(atlas), HasSubstr("; stable T 2 .. 2.27, 2.9 .. 3; "));
}

TEST(ShowStability, OfTwoPairsNeedsBoth) {
  const Header two = test::sample_header(2);
  EXPECT_EQ(stability_of(two, {{1, 0, 1, 0}, {1, 0, 3, 0}, {3, 0, 1, 0}, {1, 0.5, 1, -0.5}, {0, 0, -1, 0}}, 1e-9),
            "stable T 1, 5; ");
}

TEST(ShowStability, ByMultipliersWhereTheFlowIsNotSymplectic) {
  const Header damped = test::sample_header(1, false);
  EXPECT_EQ(stability_of(damped, {{0.5, 0.5}, {-1.1, 0}, {0.8, 0.8}, {0, -0.9}, {1.5, 0}}, 1e-9), "stable T 1, 4; ");
}

}  // namespace
}  // namespace show_stability_test
