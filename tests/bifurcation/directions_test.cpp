// Directions at crossings whose orbits have reversors: fixed lines.
#include "orbweaver/bifurcation/directions.hpp"

#include <algorithm>

#include "bifurcation/crossings.hpp"
#include "born_orbit.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::bifurcation::directions_test {
namespace {

constexpr double in_phase_doubling = 8.442930704977588;
constexpr double in_phase_branch_point = 10.416773281973249;

const loop::Isotropy& both() {
  static const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  return isotropy;
}

const test::Crossing& doubling() {
  static const test::Crossing crossing = [] {
    const corrector::Result orbit = test::orbit_at(test::even_family_to_twelve(test::in_phase()), in_phase_doubling);
    return test::crossing_at(*test::pendulum(), orbit.loop, both(), 2, 2);
  }();
  return crossing;
}

/// Part of loop - base along a direction of unit length.
double along(const Direction& direction, const loop::Loop& loop) {
  double sum = 0.0;
  for (std::size_t n = 0; n < direction.tangent.modes.size(); ++n)
    sum += direction.tangent.modes[n] * (loop.modes[n] - direction.base.modes[n]);
  return sum;
}

/// How far a loop is from every symmetry of this name, whatever its phase.
double least_defect(const loop::Loop& loop, const std::string& name) {
  const systems::Structure& system = test::pendulum()->structure();
  double least = 1e9;
  for (const bool reversing : {false, true})
    for (const systems::Symmetry& s : reversing ? system.reversors : system.equivariances)
      for (int p = 0; p < 64 && s.name == name; ++p)
        least = std::min(least, loop::symmetry_defect(loop, {name, reversing, s.map, p, 64}, system.angles));
  return least;
}

void expect_born(const Direction& direction, double amplitude, const std::string& broken) {
  const corrector::Result born =
      born_orbit(*test::pendulum(), direction.base, direction.tangent, direction.isotropy, amplitude);
  ASSERT_TRUE(born.converged()) << born.detail;
  EXPECT_NEAR(along(direction, born.loop), amplitude, 1e-9 * std::abs(amplitude));
  EXPECT_GT(least_defect(born.loop, broken), 0.1 * std::abs(amplitude));
  EXPECT_LT(std::abs(born.loop.period - direction.base.period), 10.0 * amplitude * amplitude + 1e-9);
  EXPECT_LT(certificate::certify(*test::pendulum(), born.loop).closure, 1e-9);
  EXPECT_EQ(
      loop::to_text(loop::find_isotropy(test::pendulum()->structure(), born.loop, 1e-2 * std::abs(amplitude), 16)),
      loop::to_text(direction.isotropy));
}

TEST(Directions, TwoFamiliesLeaveADoublingPoint) {
  const std::vector<Direction> found = directions(*test::pendulum(), doubling().base, both(), doubling().kernel).found;
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(loop::to_text(found[0].isotropy), "R@0");
  EXPECT_EQ(loop::to_text(found[1].isotropy), "RS@0");
  for (const Direction& direction : found) {
    EXPECT_FALSE(direction.both_sides);
    EXPECT_EQ(direction.amplitude, 0.0);
    double square = 0.0;
    for (const double v : direction.tangent.modes) square += v * v;
    EXPECT_NEAR(square, 1.0, 1e-12);
    for (const double amplitude : {1e-3, 1e-6}) expect_born(direction, amplitude, "S");
    // The first coordinate that moves at s = 0 does so upwards.
    loop::Loop v = direction.base;
    v.modes = direction.tangent.modes;
    const std::vector<double> move = loop::state_at(v, 0.0);
    EXPECT_GT(*std::find_if(move.begin(), move.end(), [](double c) { return std::abs(c) > 1e-6; }), 0.0);
  }
  // A brake orbit is at rest at s = 0; the other starts on the fixed set of RS: angles 0.
  const std::vector<double> rest = loop::state_at(found[0].base, 0.0);
  EXPECT_LT(std::hypot(rest[2], rest[3]), 1e-9);
  const std::vector<double> middle = loop::state_at(found[1].base, 0.0);
  EXPECT_LT(std::hypot(middle[0], middle[1]), 1e-9);
}

// Where the orbit starts does not matter: directions are shifted to the reversor's phase 0.
TEST(Directions, DoNotDependOnWhereTheOrbitStartsNorOnTheBasisOfTheKernel) {
  const std::vector<Direction> wanted = directions(*test::pendulum(), doubling().base, both(), doubling().kernel).found;
  test::Crossing shifted{loop::time_shifted(doubling().base, 3.0 / 8.0), {}};
  for (const double angle : {0.4, 0.4 + std::numbers::pi / 2}) {
    loop::Loop v = doubling().base;
    for (std::size_t n = 0; n < v.modes.size(); ++n)
      v.modes[n] = std::cos(angle) * doubling().kernel[0].modes[n] + std::sin(angle) * doubling().kernel[1].modes[n];
    shifted.kernel.push_back({loop::time_shifted(v, 3.0 / 8.0).modes, {}});
  }
  const std::vector<Direction> found = directions(*test::pendulum(), shifted.base, both(), shifted.kernel).found;
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(loop::to_text(found[n].isotropy), loop::to_text(wanted[n].isotropy));
    const auto born = [](const Direction& d) {
      return born_orbit(*test::pendulum(), d.base, d.tangent, d.isotropy, 1e-2).loop;
    };
    EXPECT_TRUE(loop::find_map(test::pendulum()->structure(), born(wanted[n]), born(found[n]), 1e-8, 16).has_value());
    EXPECT_NEAR(born(found[n]).period, born(wanted[n]).period, 1e-10);
  }
}

// A kernel that is good to 1e-6 gives directions that have the born orbits' symmetries to rounding.
TEST(Directions, AreExactlySymmetric) {
  std::vector<loop::Tangent> rough = doubling().kernel;
  for (std::size_t n = 0; n < rough[0].modes.size(); ++n) {
    rough[0].modes[n] += 1e-7 * std::sin(static_cast<double>(n));
    rough[1].modes[n] += 1e-7 * std::cos(static_cast<double>(n));
  }
  for (const Direction& direction : directions(*test::pendulum(), doubling().base, both(), rough).found) {
    const loop::Subspace kept(4, direction.base.cutoff, direction.isotropy);
    std::vector<double> part(static_cast<std::size_t>(kept.size()));
    kept.project(direction.tangent.modes, part);
    std::vector<double> rest = direction.tangent.modes;
    for (double& c : part) c = -c;
    kept.add_to(part, rest);
    double square = 0.0;
    for (const double c : rest) square += c * c;
    EXPECT_LT(std::sqrt(square), 1e-12);
  }
}

TEST(Directions, OneFamilyOfTheSamePeriodLosesTheReversors) {
  const corrector::Result orbit = test::orbit_at(test::even_family_to_twelve(test::in_phase()), in_phase_branch_point);
  const test::Crossing crossing = test::crossing_at(*test::pendulum(), orbit.loop, both(), 1, 1);
  const std::vector<Direction> found = directions(*test::pendulum(), crossing.base, both(), crossing.kernel).found;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(loop::to_text(found[0].isotropy), "S@1/2");
  EXPECT_FALSE(found[0].both_sides);
  for (const double amplitude : {1e-3, 1e-6}) {
    expect_born(found[0], amplitude, "R");
    expect_born(found[0], amplitude, "RS");
  }
}

TEST(Directions, RefuseWhatIsNoKernel) {
  const test::Crossing& d = doubling();
  const auto call = [&](const loop::Loop& base, std::vector<loop::Tangent> kernel) {
    return directions(*test::pendulum(), base, both(), kernel).found;
  };
  EXPECT_THROW(static_cast<void>(call(d.base, {})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(call(d.base, {d.kernel[0], d.kernel[0]})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(call(d.base, {{std::vector<double>(4, 0.5), {}}})), core::MisuseError);
  // Half of the kernel: the half map leads out of it.
  EXPECT_THROW(static_cast<void>(call(d.base, {d.kernel[0]})), core::NumericalError);
  loop::Loop crooked = d.base;
  crooked.cosine(3, 0) += 1e-3;
  crooked.sine(3, 1) += 1e-3;
  EXPECT_THROW(static_cast<void>(call(crooked, d.kernel)), core::NumericalError);
}

// As beside a saddle of the energy, where T changes by 1e9 for a change of E by 1.
TEST(Directions, OfAKernelThatIsKnownToThreeDigitsAreUndecided) {
  std::vector<loop::Tangent> rough = doubling().kernel;
  rough[0].modes.back() += 3e-3;
  const double norm = rough[0].norm();
  for (double& mode : rough[0].modes) mode /= norm;
  EXPECT_THROW(static_cast<void>(directions(*test::pendulum(), doubling().base, both(), rough)), UndecidedError);
}

// On the straight orbits of Henon and Heiles' system both families of order 4 have the reversor R and no other: one is
// at rest where the crossing's orbit turns at the triangle's side, the other where it turns towards a corner.
TEST(Directions, TwinsOfOneReversorDoNotHangOnTheStart) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<double> origin(4, 0.0);
  const starts::NormalMode mode =
      small_oscillations(*system, starts::sweep(*system, origin, {}), 10).families.at(0).mode;
  const test::Family family =
      test::family_from(system, {loop::constant_loop(origin, mode.period, 10), mode.direction, mode.isotropy}, 7.5);
  const test::Crossing crossing = test::crossing_at(*system, family.with_index(0.0), family.isotropy, 4, 2);
  std::vector<double> first;
  for (const int eighths : {0, 1, 4, 5}) {
    SCOPED_TRACE(eighths);
    const double start = eighths / 8.0;
    test::Crossing later{loop::time_shifted(crossing.base, start), {}};
    for (const loop::Tangent& v : crossing.kernel) {
      loop::Loop vector = crossing.base;
      vector.modes = v.modes;
      later.kernel.push_back({loop::time_shifted(vector, start).modes, {}});
    }
    const std::vector<Direction> found = directions(*system, later.base, family.isotropy, later.kernel).found;
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(loop::to_text(found[0].isotropy), loop::to_text(found[1].isotropy));
    std::vector<double> sizes;
    for (const Direction& direction : found) {
      const std::vector<double> z = loop::state_at(direction.base, 0.0);
      sizes.push_back(std::hypot(z[0], z[1]));
    }
    EXPECT_GT(std::abs(sizes[0] - sizes[1]), 1e-3);
    first.push_back(sizes[0]);
  }
  for (const double size : first) EXPECT_NEAR(size, first.front(), 1e-7);
}

}  // namespace
}  // namespace orbweaver::bifurcation::directions_test
