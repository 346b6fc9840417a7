// Branches of the double pendulum through the crossings at which they are born: seen from one side they arrive there.
#include <cmath>

#include <gtest/gtest.h>

#include "bifurcation/branchings.hpp"
#include "bifurcation/symmetry_gain.hpp"
#include "orbweaver/bifurcation/symmetry_watch.hpp"

namespace orbweaver::bifurcation::arrival_test {
namespace {

using test::Branching;

SymmetryWatch watch_of(const Branching& branch) {
  return SymmetryWatch(test::pendulum()->structure(), branch.isotropy);
}

void expect_one_arrival(const Branching& branch, const std::string& text) {
  const SymmetryWatch watch = watch_of(branch);
  ASSERT_EQ(branch.before.size(), 6u);
  ASSERT_EQ(branch.after.size(), 6u);
  for (std::size_t n = 0; n + 1 < branch.after.size(); ++n) {
    EXPECT_FALSE(test::first_passed(watch, branch.after[n].loop, branch.after[n + 1].loop).has_value()) << n;
    EXPECT_FALSE(test::first_passed(watch, branch.before[n].loop, branch.before[n + 1].loop).has_value()) << n;
  }
  const loop::Loop& a = branch.before[4].loop;
  const auto gain = test::first_passed(watch, a, branch.after.front().loop);
  ASSERT_TRUE(gain.has_value());
  EXPECT_EQ(test::to_text(*gain), text);
  EXPECT_LT(watch.relative_size(*gain, a, branch.crossing), 1e-5);
  double last = 1.0;
  for (const loop::Loop& at : {branch.before[5].loop, branch.crossing, branch.after[0].loop, branch.after[1].loop}) {
    EXPECT_LT(watch.signed_part(*gain, a, at), last);
    last = watch.signed_part(*gain, a, at);
  }
  // Beyond, orbits are images of those before: the broken part has turned round altogether, to 8 degrees.
  const loop::Loop& beyond = branch.after[1].loop;
  EXPECT_LT(watch.signed_part(*gain, a, beyond), -0.99 * watch.relative_size(*gain, a, beyond));
}

TEST(Arrival, OfABranchWithoutReversorGainsOne) { expect_one_arrival(test::in_phase_branch(), "R"); }

TEST(Arrival, OfADoubledBrakeOrbitGainsAQuarter) { expect_one_arrival(test::in_phase_double(), "S@1/4"); }

// The base family passes its own crossings without gaining anything.
TEST(Arrival, OfTheBaseFamilyThereIsNone) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  const SymmetryWatch watch(test::pendulum()->structure(), test::pendulum_isotropy(*test::pendulum()));
  for (std::size_t n = 0; n + 1 < orbits.size(); ++n)
    EXPECT_FALSE(test::first_passed(watch, orbits[n].loop, orbits[n + 1].loop).has_value())
        << "T = " << orbits[n].loop.period;
}

}  // namespace
}  // namespace orbweaver::bifurcation::arrival_test
