#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "bifurcation/sweep.hpp"
#include "continuation/families.hpp"
#include "orbweaver/bifurcation/stability_of_orbit.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace pendulum_test {
namespace {

using namespace orbweaver;
using bifurcation::TestFunction;

struct Crossing {
  int q;
  int j;
  double period;
};

/// Stations at the family's orbits, by their periods; orbits in between re-converged at theirs.
void expect_crossings(const test::PendulumMode& mode, const std::vector<Crossing>& expected) {
  const auto system = test::pendulum();
  const test::Trace& family = test::family_to_twelve(mode);
  const loop::Isotropy isotropy = test::pendulum_isotropy(*system);
  const auto stability_at = [&](double period) {
    for (const continuation::Orbit& orbit : family.orbits)
      if (orbit.loop.period == period) return spectrum::floquet(*system, orbit.loop, isotropy);
    const corrector::Result orbit = test::orbit_at(family, period);
    EXPECT_TRUE(orbit.converged());
    return spectrum::floquet(*system, orbit.loop, isotropy);
  };
  std::vector<double> periods;
  for (const continuation::Orbit& orbit : family.orbits) periods.push_back(orbit.loop.period);
  const auto functions = bifurcation::test_functions(system->structure(), 2, 4);
  const test::Detection found = test::detect(system->structure(), stability_at, functions, periods, 1e-11);
  ASSERT_EQ(found.events.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(found.events[n].function, (TestFunction{TestFunction::Kind::sector, {expected[n].q, expected[n].j}}));
    EXPECT_NEAR(found.events[n].position, expected[n].period, 1e-9);
    EXPECT_FALSE(found.events[n].tangency);
  }
  EXPECT_LE(found.probes, 20);
}

TEST(PendulumCrossings, InPhase) {
  expect_crossings(test::in_phase(), {{4, 1, 8.442930704977588},
                                      {4, 1, 8.667969327257},
                                      {4, 1, 9.825020348886},
                                      {6, 1, 10.180534055738},
                                      {8, 1, 10.287065170436},
                                      {1, 0, 10.416773281973249}});
}

// Where the family without the reversor leaves, an index is 2. Rounding moves orbits that keep the half turn alone
// along that family, and their index with them: by more than the bound of one loop's index says.
TEST(StabilityOfAnOrbit, KnowsAnIndexNoBetterThanTheOrbit) {
  const auto system = test::pendulum();
  const loop::Isotropy isotropy = test::pendulum_isotropy(*system);
  const loop::Isotropy half_turn{isotropy.front().reversing ? isotropy.back() : isotropy.front()};
  const test::Trace& family = test::family_to_twelve(test::in_phase());
  const auto errors_at = [&](double period, const loop::Isotropy& kept) {
    const loop::Loop orbit = test::orbit_at(family, period).loop;
    return std::array{spectrum::floquet(*system, orbit, kept).fundamental_error.front(),
                      bifurcation::stability_of(*system, orbit, kept).fundamental_error.front()};
  };
  const auto [of_loop, of_orbit] = errors_at(10.416773282, half_turn);
  EXPECT_GT(of_orbit, 1.5 * of_loop);
  const auto [regular_loop, regular_orbit] = errors_at(9.0, half_turn);
  EXPECT_EQ(regular_orbit, regular_loop);
  const auto [kept_loop, kept_orbit] = errors_at(10.416773282, isotropy);
  EXPECT_LT(kept_orbit, 10.0 * kept_loop);
}

TEST(PendulumCrossings, OutPhase) {
  expect_crossings(test::out_phase(),
                   {{4, 1, 4.059557792801163}, {6, 1, 5.177415388176}, {8, 1, 5.609599035409}, {1, 0, 6.147515349731}});
}

TEST(PendulumCrossings, DownUpHasNone) { expect_crossings(test::down_up(), {}); }

TEST(PendulumCrossings, UpDownHasNone) { expect_crossings(test::up_down(), {}); }

}  // namespace
}  // namespace pendulum_test
