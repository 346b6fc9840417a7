#include "show_stability.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "archive/sample.hpp"

namespace show_stability_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using namespace orbweaver::report;

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

}  // namespace
}  // namespace show_stability_test
