// Families that nearly touch: those of the double pendulum with equal masses and lengths that the deep survey has.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "survey/atlas.hpp"

namespace gaps_test {
namespace {

using namespace orbweaver;

constexpr double last_energy = 1.35;

const test::Atlas& deep_families() {
  static const test::Atlas atlas = [] {
    const core::Communicator comm;
    const survey::Summary summary =
        test::run(comm,
                  scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum_deep.yaml",
                              {"survey.depth=2", "survey.subharmonics=3", "limits.period=33",
                               fmt::format("limits.energy=[-.inf, {}]", last_energy), "starts.sweep.period=[8, 9]",
                               "starts.fixed_points.grid=[[0], [0]]",
                               "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}"}),
                  "deep");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    for (const survey::FindingSummary& finding : summary.findings)
      EXPECT_EQ(finding.severity, survey::Severity::cut) << finding.text;
    return test::Atlas(summary.atlas);
  }();
  return atlas;
}

loop::Loop last_loop(const std::string& family) {
  const test::Atlas& atlas = deep_families();
  const auto row = atlas.row_of(family);
  return archive::loop_of(atlas,
                          static_cast<std::size_t>(atlas.families().integers("first_orbit")[row] +
                                                   atlas.families().integers("orbit_count")[row] - 1),
                          {0, 1});
}

struct First {
  double index = 0.0;  ///< of the first orbit
  double error = 0.0;
  double side = 0.0;  ///< its energy less that of the crossing where the family is born
};
First first_orbit(const std::string& family) {
  const test::Atlas& atlas = deep_families();
  const std::size_t at = atlas.row_of(family);
  const auto row = static_cast<std::size_t>(atlas.families().integers("first_orbit")[at]);
  const auto crossing = static_cast<std::size_t>(atlas.families().integers("crossing")[at]);
  return {atlas.orbits().reals("stability")[row], atlas.orbits().reals("stability_error")[row],
          atlas.orbits().reals("energy")[row] - atlas.crossings().reals("energy")[crossing]};
}

// K. R. Meyer 1970, doi:10.1090/S0002-9947-1970-0259289-X: of the two families born at a multiplier e^(2 pi i j/q) one
// is elliptic and one hyperbolic if q > 4. If q = 4 that is so where both lie on one side in energy; where they do not,
// both are hyperbolic. q is that of the half map.
TEST(Gaps, TwinsAreEllipticAndHyperbolicAsTheyMustBe) {
  for (const std::string twins : {"ID1", "ID2", "IT3", "IBT3-1", "IBD"}) {
    test::HardCase row(fmt::format("twins {0}a and {0}b", twins), "Meyer's theorem: signs of k - 2");
    const First a = first_orbit(twins + "a");
    const First b = first_orbit(twins + "b");
    const bool on_one_side = a.side * b.side > 0.0;
    const double x = a.index - 2.0;
    const double y = b.index - 2.0;
    row.is(std::abs(x) > a.error && std::abs(y) > b.error && (on_one_side ? x * y < 0.0 : x > 0.0 && y > 0.0),
           on_one_side ? "one of each" : "both +", fmt::format("{:+.1e}, {:+.1e}", x, y));
  }
}

// At one energy all of them are different orbits: by a second integrator each is one, and no two have one period and
// action.
TEST(Gaps, AllAreOrbitsAndDifferent) {
  const test::Atlas& atlas = deep_families();
  const test::reference::DoublePendulum law;
  double worst = 0.0;
  std::vector<std::pair<double, double>> seen;
  test::HardCase row("families of the deep survey at E = 1.35", "each closes by extrapolation, 200 parts");
  for (const std::string& family : atlas.families().texts("name")) {
    if (std::abs(atlas.column("energy", family).back() - last_energy) > 1e-9) continue;
    const loop::Loop loop = last_loop(family);
    for (int n = 0; n < 200; ++n) {
      const auto here = test::reference::point_of<4>(loop::state_at(loop, loop.period * n / 200));
      const auto there = test::reference::point_of<4>(loop::state_at(loop, loop.period * (n + 1) / 200));
      const auto reached = test::reference::flow(law, here, test::reference::Real(loop.period) / 200);
      worst = test::worse(worst, static_cast<double>(test::reference::distance(reached, there)));
    }
    seen.emplace_back(loop.period, atlas.column("action", family).back());
  }
  row.within(worst, 1e-10);
  ASSERT_GE(seen.size(), 12U);
  double nearest = 1.0;
  for (std::size_t a = 0; a < seen.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      nearest = std::min(nearest, std::hypot(seen[a].first - seen[b].first, seen[a].second - seen[b].second));
  test::HardCase(fmt::format("{} families of the deep survey at E = 1.35", seen.size()), "no two have one T and action")
      .is(nearest > 1e-6, "apart", fmt::format("{:.1e} apart", nearest));
}

// dW/dE = T along each family: between neighbours the slope of W lies between their T, unless T turns or one of them
// has jumped to a neighbour.
TEST(Gaps, NoneJumpsToItsNeighbour) {
  const test::Atlas& atlas = deep_families();
  test::HardCase row("families of the deep survey",
                     "dW/dE between the T of neighbours, off by parts of their difference");
  double worst = 0.0;
  for (const std::string& family : atlas.families().texts("name")) {
    const std::vector<double> periods = atlas.column("period", family);
    const std::vector<double> energies = atlas.column("energy", family);
    const std::vector<double> actions = atlas.column("action", family);
    for (std::size_t n = 1; n < periods.size(); ++n) {
      const double rise = energies[n] - energies[n - 1];
      const double slope = (actions[n] - actions[n - 1]) / rise;
      const double low = std::min(periods[n], periods[n - 1]);
      const double high = std::max(periods[n], periods[n - 1]);
      const double rounding = 1e-12 * std::abs(actions[n] / rise);
      worst = test::worse(worst, std::max({0.0, low - slope, slope - high}) / (high - low + rounding));
    }
  }
  row.within(worst, 0.5);
}

}  // namespace
}  // namespace gaps_test
