// Two period doublings that lie as close as one likes.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "survey/surveyed_well.hpp"
#include "survey/widened.hpp"

namespace parted_crossings_test {
namespace {

using namespace orbweaver;

std::map<std::string, double> well(double c) { return test::well({0.45, 0.0, 0.0, c, 0.0, 0.1, 0.5, 0.1}); }

/// The energies at which mode 2, along y = 0, is doubled: across it y'' = -(w2^2 + 2 c x + f x^2) y.
std::vector<double> doublings(double c, const std::string& start) {
  const test::Atlas atlas =
      test::survey_of(well(c), {"limits.energy=[0, 0.2]", "limits.period=8", "continuation.start=" + start});
  std::vector<double> energies;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().texts("kind")[row] == "period-doubling")
      energies.push_back(atlas.crossings().reals("energy")[row]);
  std::sort(energies.begin(), energies.end());
  return energies;
}

// They are the ends of a resonance tongue, whose width is proportional to c where that is small. The index passes -2 by
// the square of that, and from c = 1e-6 on by less than its rounding.
TEST(PartedCrossings, LieApartInProportionToWhatPartsThem) {
  const std::vector<double> wide = doublings(1e-4, "0.01");
  ASSERT_EQ(wide.size(), 2U);
  for (const double c : {1e-5, 1e-6, 1e-7, 1e-8})
    for (const std::string start : {"0.01", "0.016", "0.025"}) {
      SCOPED_TRACE(fmt::format("{}, {}", c, start));
      const std::vector<double> near = doublings(c, start);
      ASSERT_EQ(near.size(), 2U);
      const double expected = (wide[1] - wide[0]) * c / 1e-4;
      EXPECT_NEAR(near[1] - near[0], expected, 1e-3 * expected + 1e-11);
    }
}

TEST(PartedCrossings, AreTheSameAfterNarrowerLimits) {
  const auto scene_with = [](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(),
                     {"starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                      "starts.fixed_points.grid=[[0], [0], [0], [0]]", "starts.sweep.period=auto", "survey.depth=1",
                      "survey.subharmonics=2", "limits.energy=[0, 0.2]", "limits.period=16"});
    return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", overrides);
  };
  for (const std::string limit : {"survey.depth=0", "limits.period=8"}) {
    SCOPED_TRACE(limit);
    test::expect_same_when_widened(core::Communicator(), scene_with, {limit}, test::uneven_well(well(1e-6)));
  }
}

}  // namespace
}  // namespace parted_crossings_test
