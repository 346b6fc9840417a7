#include "orbweaver/bifurcation/identity.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "bifurcation/branchings.hpp"
#include "loop/samples.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"

namespace orbweaver::bifurcation::identity_test {
namespace {

using continuation::Orbit;
using test::measured;

const double irrational = std::sqrt(2.0) / 7.0;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const systems::Structure& pendulum() { return test::pendulum()->structure(); }
loop::Isotropy isotropy() { return test::pendulum_isotropy(*test::pendulum()); }

Comparison compare(const Orbit& a, const Orbit& b, const loop::Isotropy& own, const loop::Loop& x) {
  return same_family(*test::pendulum(), a, b, own, measured(x));
}

// Without energy and action: only the loops can tell.
Comparison compare_loops(const Orbit& a, const Orbit& b, const loop::Isotropy& own, const loop::Loop& x) {
  Orbit orbit;
  orbit.loop = x;
  orbit.energy = orbit.action = unknown;
  return same_family(*test::pendulum(), a, b, own, orbit);
}

std::vector<loop::Loop> images_of(const loop::Loop& x) {
  std::vector<loop::Loop> out{x, loop::time_shifted(x, irrational), loop::time_shifted(x, 0.25)};
  for (const systems::Symmetry& s : pendulum().equivariances)
    out.push_back(loop::transformed(x, s.map, false, irrational));
  for (const systems::Symmetry& r : pendulum().reversors) out.push_back(loop::transformed(x, r.map, true, 0.3));
  out.push_back(loop::repeated(loop::time_shifted(loop::evenly_in_time(x), irrational), 2));
  out.push_back(x);
  out.back().cosine(0, 1) -= 4.0 * std::numbers::pi;
  return out;
}

// Compares with the neighbours on one side of a crossing between whose periods that of x lies.
Comparison compare(const std::vector<Orbit>& side, const loop::Isotropy& own, const loop::Loop& x) {
  std::size_t n = 0;
  while (n + 2 < side.size() && (side[n].loop.period - x.period) * (side[n + 1].loop.period - x.period) > 0.0) ++n;
  return compare(side[n], side[n + 1], own, x);
}

/// The in-phase orbit of this period with this m2, as one of a family in m2.
Orbit in_mass(const systems::System& family, double period, double m2) {
  const auto system = systems::make_system("double_pendulum", {{"m2", m2}});
  const corrector::Result found =
      continuation::orbit_at_period(*system, test::even_in_phase_orbit(period), isotropy(), period, {});
  EXPECT_TRUE(found.converged()) << found.detail;
  Orbit out;
  out.loop = found.loop;
  out.loop.parameters = {m2};
  out.energy = continuation::energy_of(family, out.loop);
  out.action = continuation::action_of(family, out.loop);
  return out;
}

TEST(Identity, OfOrbitsOfAFamilyInAParameterThatHoldsThePeriod) {
  using systems::FamilyScalars;
  const auto family = systems::make_system("double_pendulum", {}, {}, {{"m2"}, FamilyScalars::Hold::period});
  const Orbit a = in_mass(*family, 9.0, 1.0);
  const Orbit b = in_mass(*family, 9.0, 1.04);
  const Comparison own = same_family(*family, a, b, isotropy(), in_mass(*family, 9.0, 1.02));
  EXPECT_TRUE(own.same) << own.detail;
  EXPECT_NEAR(own.position, 0.5, 0.05);
  for (const double period : {9.001, 9.01}) {
    const Comparison other = same_family(*family, a, b, isotropy(), in_mass(*family, period, 1.02));
    EXPECT_FALSE(other.same);
    EXPECT_TRUE(other.decided) << other.detail;
  }
}

TEST(Identity, OfOneOrbitWithItsImages) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  const loop::Loop& orbit = orbits[10].loop;
  for (const loop::Loop& image : images_of(orbit)) EXPECT_TRUE(same_orbit(*test::pendulum(), orbit, image));
  EXPECT_FALSE(same_orbit(*test::pendulum(), orbit, orbits[11].loop));
  loop::Loop longer = orbit;
  longer.period *= 1.0 + 1e-4;
  EXPECT_FALSE(same_orbit(*test::pendulum(), orbit, longer));
}

TEST(Identity, OfAnOrbitBetweenItsNeighbours) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  for (std::size_t n = 3; n + 1 < orbits.size(); n += 6) {
    const Comparison found = compare(orbits[n - 1], orbits[n + 1], isotropy(), orbits[n].loop);
    EXPECT_TRUE(found.same) << found.detail << ", T = " << orbits[n].loop.period;
    EXPECT_LT(found.distance, 1e-8);
    EXPECT_GT(found.position, 0.0);
    EXPECT_LT(found.position, 1.0);
    const double period = orbits[n - 1].loop.period + 1.5 * (orbits[n + 1].loop.period - orbits[n - 1].loop.period);
    const loop::Loop later = test::orbit_at(test::family_to_twelve(test::in_phase()), period).loop;
    EXPECT_EQ(compare_loops(orbits[n - 1], orbits[n + 1], isotropy(), later).detail, "beyond the neighbours");
  }
}

TEST(Identity, UnderShiftsSymmetriesReversalAndRepetition) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  const std::size_t n = orbits.size() / 2;
  for (const loop::Loop& image : images_of(orbits[n].loop)) {
    const Comparison found = compare(orbits[n - 1], orbits[n + 1], isotropy(), image);
    EXPECT_TRUE(found.same) << found.detail << " " << found.distance;
  }
}

// No reversor fixes the phase: the chord's orbit and x find one another by turns.
TEST(Identity, OfOrbitsWithoutReversor) {
  const test::Branching& branch = test::in_phase_branch();
  ASSERT_GE(branch.after.size(), 5u);
  for (const loop::Loop& image : images_of(branch.after[3].loop)) {
    const Comparison found = compare(branch.after[2], branch.after[4], branch.isotropy, image);
    EXPECT_TRUE(found.same) << found.detail << " " << found.distance;
  }
  // Nor do stored orbits begin alike: neighbours in another phase are the same neighbours.
  for (const double shift : {0.01, irrational}) {
    Orbit later = branch.after[4];
    later.loop = loop::time_shifted(later.loop, shift);
    const Comparison found = compare(branch.after[2], later, branch.isotropy, branch.after[3].loop);
    EXPECT_TRUE(found.same) << shift << ": " << found.detail << " " << found.distance;
  }
  // Along a long chord the first correction comes within 1e-7 only.
  IdentityOptions options;
  options.tolerance = 1e-10;
  const Comparison far = same_family(*test::pendulum(), branch.after[0], branch.after[5], branch.isotropy,
                                     measured(loop::time_shifted(branch.after[4].loop, irrational)), options);
  EXPECT_TRUE(far.same) << far.detail << " " << far.distance;
  // The half on the other side of the crossing is the mirror image.
  const Comparison mirrored = compare(branch.after, branch.isotropy, branch.before[2].loop);
  EXPECT_TRUE(mirrored.same) << mirrored.detail << " " << mirrored.distance;
}

TEST(Identity, OfRotations) {
  const loop::Isotropy own{test::element_of(pendulum(), "RS")};
  const auto rotation = [&](double period) {
    loop::Loop guess =
        loop::constant_loop(std::vector<double>{0.0, 0.0, test::two_pi / period, test::two_pi / period}, period, 17);
    guess.winding = {1.0, 1.0, 0.0, 0.0};
    guess.sine(1, 0) = 0.01;
    const corrector::Result result = continuation::orbit_at_period(*test::pendulum(), guess, own, period, {});
    EXPECT_TRUE(result.converged()) << result.detail;
    return measured(result.loop);
  };
  const Orbit a = rotation(1.0);
  const Orbit b = rotation(1.05);
  const loop::Loop x = loop::with_time_map(rotation(1.03).loop, {1.1, {}}, 58);
  for (const loop::Loop& image : images_of(x)) {
    const Comparison found = compare(a, b, own, image);
    EXPECT_TRUE(found.same) << found.detail << " " << found.distance;
  }
}

TEST(Identity, TellsFamiliesOfOnePeriodApart) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  const std::size_t n = orbits.size() / 2;
  const loop::Loop other = test::orbit_at(test::family_to_twelve(test::out_phase()), orbits[n].loop.period).loop;
  EXPECT_EQ(compare(orbits[n - 1], orbits[n + 1], isotropy(), other).detail,
            "period, energy, parameter or action out of range");
  const Comparison by_loops = compare_loops(orbits[n - 1], orbits[n + 1], isotropy(), other);
  EXPECT_FALSE(by_loops.same);
  EXPECT_GT(by_loops.distance, 0.1);
}

// Near a crossing another family is close, and its orbits have nearly the same invariants.
TEST(Identity, TellsABranchFromTheFamilyThatItLeaves) {
  const auto& orbits = test::family_to_twelve(test::in_phase()).orbits;
  const test::Branching& branch = test::in_phase_branch();
  std::size_t n = 0;
  while (orbits[n + 1].loop.period < branch.after.front().loop.period) ++n;
  const Comparison found = compare(orbits[n], orbits[n + 1], isotropy(), branch.after.front().loop);
  EXPECT_FALSE(found.same);
  EXPECT_EQ(found.detail, "another orbit");
  EXPECT_GT(found.distance, 1e-3);
  const loop::Loop beside = test::even_in_phase_orbit(branch.after[1].loop.period);
  EXPECT_FALSE(compare(branch.after[0], branch.after[2], branch.isotropy, beside).same);
}

TEST(Identity, OfADoubledOrbitIsNotThatOfItsPrimitive) {
  const test::Branching& branch = test::in_phase_double();
  const loop::Loop once = test::even_in_phase_orbit(0.5 * branch.after[1].loop.period);
  EXPECT_FALSE(compare(branch.after[0], branch.after[2], branch.isotropy, loop::repeated(once, 2)).same);
  EXPECT_TRUE(compare(branch.after[0], branch.after[2], branch.isotropy, branch.after[1].loop).same);
  // Half a period later the orbits are those of the other side.
  const Comparison mirrored = compare(branch.after, branch.isotropy, branch.before[4].loop);
  EXPECT_TRUE(mirrored.same) << mirrored.detail << " " << mirrored.distance;
}

TEST(Identity, InvariantsRejectWithoutSolving) {
  Orbit a, b, x;
  a.loop.period = 2.0, b.loop.period = 3.0, x.loop.period = 2.5;
  a.energy = -1.0, b.energy = 1.0, x.energy = 0.0;
  a.action = b.action = x.action = 4.0;
  EXPECT_TRUE(may_lie_between(a, b, x, 1e-2));
  x.energy = 2.02;
  EXPECT_FALSE(may_lie_between(a, b, x, 1e-2)) << "half the range beyond, and 0.01 x 4 / 2.5";
  x.energy = 2.01;
  EXPECT_TRUE(may_lie_between(a, b, x, 1e-2));
  x.energy = unknown;
  EXPECT_TRUE(may_lie_between(a, b, x, 1e-2));
  x.action = 4.05;
  EXPECT_FALSE(may_lie_between(a, b, x, 1e-2));
  x.action = 4.0;
  x.loop.period = 1.4;
  EXPECT_FALSE(may_lie_between(a, b, x, 1e-2));
}

}  // namespace
}  // namespace orbweaver::bifurcation::identity_test
