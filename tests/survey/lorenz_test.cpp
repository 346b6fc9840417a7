// Lorenz's equations: the families of their Hopf points, and the symmetric orbit around both equilibria.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"

namespace lorenz_test {
namespace {

using namespace orbweaver;

scene::Scene lorenz(const std::vector<std::string>& more) {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/lorenz.yaml", more);
}

TEST(Lorenz, GoesFromItsHopfPointsToTheHomoclinicOrbits) {
  constexpr double hopf = 470.0 / 19.0;
  constexpr double homoclinic = 13.926557407;
  const core::Communicator comm;
  // With one equilibrium given the Hopf point of the other is found on the same curve.
  for (const std::string grid : {"[[-8, 0, 8], [-8, 0, 8], [0, 27]]", "[[-8], [-8], [27]]"}) {
    SCOPED_TRACE(grid);
    const survey::Summary summary = test::run(comm, lorenz({"starts.fixed_points.grid=" + grid}), "lorenz");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    ASSERT_EQ(summary.families.size(), 2U);
    const bool both = grid.size() > 20;
    EXPECT_EQ(summary.families[0].name, "Equilibrium 1, Hopf point 1");
    EXPECT_EQ(summary.families[1].name, both ? "Equilibrium 3, Hopf point 1" : "Equilibrium 1, Hopf point 2");
    const test::Atlas atlas(summary.atlas);
    for (const survey::FamilySummary& family : summary.families) {
      const std::vector<double> rho = atlas.column("parameter", family.name);
      const std::vector<double> period = atlas.column("period", family.name);
      const double amplitude = hopf - rho.front();  // rho leaves with the square of the amplitude
      EXPECT_GT(amplitude, 0.0);
      EXPECT_LT(amplitude, 2e-3);
      EXPECT_NEAR(period.front(), 2.0 * std::numbers::pi / std::sqrt(8.0 / 3.0 * (hopf + 10.0)), 1e-3);
      EXPECT_EQ(period.back(), 30.0);
      EXPECT_NEAR(rho.back(), homoclinic, 1e-8);
    }
  }
}

/// D. Viswanath's shortest orbit (2003, doi:10.1088/0951-7715/16/3/314), which goes around both equilibria.
TEST(Lorenz, TheOrbitAroundBothEquilibriaHasItsMirrorImage) {
  constexpr double period = 1.558652210716;
  const core::Communicator comm;
  for (const std::string state : {"-13.763610682134, -19.578751942452, 27", "-13.76, -19.58, 27"}) {
    SCOPED_TRACE(state);
    const survey::Summary summary =
        test::run(comm,
                  lorenz({"starts={states: [{state: [" + state + "], period: 1.5587, name: Both}]}",
                          "system.parameters.rho=28", "limits.parameter=[27, 29]", "limits.steps=3"}),
                  "both");
    EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    ASSERT_EQ(summary.families.size(), 1U);
    const test::Atlas atlas(summary.atlas);
    EXPECT_EQ(atlas.families().texts("isotropy").front(), "S@1/2");
    const std::vector<double> rho = atlas.column("parameter", "Both");
    const auto at = static_cast<std::size_t>(std::find(rho.begin(), rho.end(), 28.0) - rho.begin());
    ASSERT_LT(at, rho.size());
    EXPECT_GT(at, 0U) << "it runs to both sides";
    EXPECT_NEAR(atlas.column("period", "Both")[at], period, 1e-11);
    const loop::Loop orbit = archive::loop_of(atlas, at, {});
    double largest = 0.0;
    for (const double time : {0.0, 0.1, 0.37}) {
      const std::vector<double> here = loop::state_at(orbit, time * orbit.period);
      const std::vector<double> later = loop::state_at(orbit, (time + 0.5) * orbit.period);
      for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(later[i], -here[i], 1e-9);
      EXPECT_NEAR(later[2], here[2], 1e-9);
      largest = std::max(largest, std::abs(here[0]));
    }
    EXPECT_GT(largest, 5.0) << "it is at neither equilibrium";
  }
}

}  // namespace
}  // namespace lorenz_test
