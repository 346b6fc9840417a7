#include "orbweaver/bifurcation/family_jump.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "support/dual_derivatives.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "support/delegating_system.hpp"
#include "turning_sense.hpp"

namespace family_jump_test {
namespace {

using namespace orbweaver;
using bifurcation::has_jumped;
using continuation::Options;
using continuation::Orbit;

/// The double pendulum with charged joints in a magnetic field: the generalised force B (w2, -w1) does no work, keeps S
/// and breaks both reversors.
class MagneticPendulum final : public test::DelegatingSystem {
 public:
  explicit MagneticPendulum(double strength)
      : DelegatingSystem(test::pendulum()), _force{strength}, _structure(whole().structure()) {
    _structure.reversors.clear();
  }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }
  void field(std::size_t nodes, const double* z, double* f) const override {
    test::pendulum()->field(nodes, z, f);
    add(nodes, z, f, nullptr);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    test::pendulum()->field_jacobian(nodes, z, f, jacobian);
    add(nodes, z, f, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* out) const override {
    test::pendulum()->second_derivatives(nodes, z, weights, out);
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto added = ad::second_derivatives<4>(_force, at(nodes, n, z).data(), at(nodes, n, weights).data());
      for (std::size_t i = 0; i < 16; ++i) out[i * nodes + n] += added[i];
    }
  }

 private:
  struct Force {
    double strength;

    template <class S>
    void operator()(const S* z, S* f) const {
      using std::cos;
      const S c = cos(z[0] - z[1]);
      const S share = S(strength) / (S(2.0) - c * c);
      f[0] = f[1] = z[0] * 0.0;
      f[2] = (z[3] + c * z[2]) * share;
      f[3] = (c * z[3] + z[2] * 2.0) * share * -1.0;
    }
  };

  static std::array<double, 4> at(std::size_t nodes, std::size_t n, const double* values) {
    return {values[n], values[nodes + n], values[2 * nodes + n], values[3 * nodes + n]};
  }

  void add(std::size_t nodes, const double* z, double* f, double* jacobian) const {
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto added = ad::field_jacobian<4>(_force, at(nodes, n, z).data());
      for (std::size_t i = 0; i < 4; ++i) f[i * nodes + n] += added.value[i];
      for (std::size_t i = 0; jacobian != nullptr && i < 16; ++i) jacobian[i * nodes + n] += added.jacobian[i];
    }
  }

  Force _force;
  systems::Structure _structure;
};

loop::Isotropy without_reversors() {
  loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  std::erase_if(isotropy, [](const loop::SymmetryElement& e) { return e.reversing; });
  return isotropy;
}

continuation::Start in_phase_start() {
  continuation::Start start = test::start_of(test::in_phase());
  start.isotropy = without_reversors();
  return start;
}

/// A family followed in the subspace of S@1/2 alone; `held`: steps that jump are taken back.
struct Followed {
  std::shared_ptr<const systems::System> system;
  Options plain{};
  std::vector<Orbit> orbits{};
  std::vector<double> indices{};
  int refused = 0;
  continuation::Ending ending{};

  Followed(std::shared_ptr<const systems::System> of, const continuation::Start& start, bool held)
      : system(std::move(of)) {
    plain.period_limit = 11.0;
    plain.fit_time_map = false;
    Options options = plain;
    if (held) options.jumped = [this](const Orbit& from, const Orbit& to) { return jumped(from, to); };
    ending = continuation::trace(system, start, options, [this](const Orbit& orbit) {
      orbits.push_back(orbit);
      indices.push_back(stability(orbit).fundamental[0].real());
      return true;
    });
  }

  [[nodiscard]] spectrum::Stability stability(const Orbit& orbit) const {
    return spectrum::floquet(*system, orbit.loop, without_reversors());
  }

  [[nodiscard]] bool jumped(const Orbit& from, const Orbit& to) {
    const bool jump = has_jumped(system, without_reversors(), plain, {from, stability(from)}, {to, stability(to)});
    if (jump) ++refused;
    return jump;
  }

  /// Steps across which the index passes 2.
  [[nodiscard]] std::vector<std::size_t> passing_two() const {
    std::vector<std::size_t> steps;
    for (std::size_t n = 1; n < orbits.size(); ++n)
      if ((indices[n - 1] - 2.0) * (indices[n] - 2.0) < 0.0) steps.push_back(n);
    return steps;
  }

  /// Steps at which the energy turns.
  [[nodiscard]] std::vector<std::size_t> turning() const {
    std::vector<std::size_t> steps;
    for (std::size_t n = 2; n < orbits.size(); ++n)
      if ((orbits[n].energy - orbits[n - 1].energy) * (orbits[n - 1].energy - orbits[n - 2].energy) < 0.0)
        steps.push_back(n);
    return steps;
  }
};

// At T = 10.4168 the in-phase family of the ideal pendulum crosses IB, which breaks both reversors. In the field the
// two curves pass one another instead, at a distance of about the cube root of its strength, and turn ever more
// sharply.
class FamilyJump : public ::testing::TestWithParam<double> {
 protected:
  std::shared_ptr<const systems::System> system = std::make_shared<MagneticPendulum>(GetParam());
  Followed loose{system, in_phase_start(), false};

  /// The other curve, from beyond the gap backwards: down to a fold, and up again.
  [[nodiscard]] Followed other_curve() const {
    const Orbit& last = loose.orbits.back();
    const Orbit& before = loose.orbits[loose.orbits.size() - 2];
    continuation::Start back{last.loop, {}, without_reversors()};
    const loop::Loop towards = loop::with_cutoff(before.loop, last.loop.cutoff);
    for (std::size_t n = 0; n < towards.modes.size(); ++n)
      back.direction.modes.push_back(towards.modes[n] - last.loop.modes[n]);
    return {system, back, true};
  }
};

TEST_P(FamilyJump, StepsAcrossTheGapBetweenTwoFamiliesAreTakenBack) {
  EXPECT_EQ(loose.passing_two().size(), 1U) << "if it does not jump, this is no test";
  EXPECT_TRUE(loose.turning().empty());

  const Followed held(system, in_phase_start(), true);
  EXPECT_EQ(held.ending.reason, continuation::EndReason::period_limit) << held.ending.text();
  EXPECT_TRUE(held.passing_two().empty());
  EXPECT_TRUE(held.turning().empty());
  EXPECT_GT(held.refused, 0);
  EXPECT_LT(held.orbits.size(), 3 * loose.orbits.size());
  EXPECT_GT(*std::max_element(held.indices.begin(), held.indices.end()), 1.9) << "it comes near";
  // Both end at T = 11, on different orbits.
  EXPECT_GT(std::abs(held.orbits.back().energy - loose.orbits.back().energy), 1e-3);
}

TEST_P(FamilyJump, AFoldInTheEnergyIsNone) {
  Followed held = other_curve();
  EXPECT_EQ(held.ending.reason, continuation::EndReason::period_limit) << held.ending.text();
  ASSERT_EQ(held.passing_two().size(), 1U);
  ASSERT_EQ(held.turning().size(), 1U);
  const std::size_t across = held.passing_two()[0];
  EXPECT_LE(held.turning()[0] - across, 1U) << "the step of the fold, or the next one shows it";
  EXPECT_GT(held.indices.front(), 2.0);
  EXPECT_LT(held.indices.back(), 2.0);
  EXPECT_FALSE(held.jumped(held.orbits[across - 1], held.orbits[across]));
  EXPECT_TRUE(held.jumped(held.orbits.front(), held.orbits.back())) << "so far apart it cannot be told";
}

// Where the one curve comes up to the gap its index is far below 2; beside the fold of the other its energy falls too.
TEST_P(FamilyJump, AStepOntoTheOtherCurveBesideItsFoldIsTakenBack) {
  Followed near(system, in_phase_start(), true);
  const Followed other = other_curve();
  int pairs = 0;
  for (std::size_t n = 0; n < near.orbits.size(); ++n) {
    for (std::size_t m = 0; m < other.orbits.size(); ++m) {
      const bool is_above = other.indices[m] > 2.0 && other.indices[m] < 2.5;
      if (!is_above || near.indices[n] < 0.5 || near.indices[n] > 1.9) continue;
      ++pairs;
      EXPECT_TRUE(near.jumped(near.orbits[n], other.orbits[m])) << near.indices[n] << " to " << other.indices[m];
    }
  }
  EXPECT_GT(pairs, 3);
}

INSTANTIATE_TEST_SUITE_P(Fields, FamilyJump, ::testing::Values(5e-13, 3.4e-11, 2.2e-9, 2.7e-8, 1e-6, 1e-5));

// Planes across a chord over the gap meet the one family up to some place, and the other from there on: no index is 2.
// Whether an orbit is found in all of them that are asked hangs on rounding: of many chords some get there, and none
// finds a crossing.
TEST(Jumps, AnIndexThatPassesTwoByAJumpIsNoCrossing) {
  const auto system = std::make_shared<MagneticPendulum>(2.7e-8);
  const Followed loose(system, in_phase_start(), false);
  ASSERT_EQ(loose.passing_two().size(), 1U);
  const std::size_t across = loose.passing_two()[0];
  const bifurcation::Event event{bifurcation::Event::Kind::test_function,
                                 {bifurcation::TestFunction::Kind::sector, {1, 0}}};
  int jumps = 0;
  for (const std::size_t before : {3U, 4U})
    for (int n = 0; n < 10; ++n) {
      const double end = 1.0 + 0.01 * n;  // another place is asked first
      continuation::FamilyCurve curve(system, without_reversors(), loose.plain);
      curve.add(0.0, loose.orbits[across - before].loop);
      curve.add(end, loose.orbits[across + 2].loop);
      bifurcation::NotLocated why;
      const auto crossing = bifurcation::locate(*system, curve, event, 0.0, end, why);
      EXPECT_FALSE(crossing) << "an index of 2 to " << crossing->reading.value << ", bound " << crossing->reading.error;
      if (why.reason == bifurcation::NotLocated::Reason::no_orbit) continue;
      EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_crossing) << to_text(why);
      EXPECT_GT(why.at_from, 1e-6);
      EXPECT_NE(to_text(why).find("changes its sign by a jump"), std::string::npos);
      ++jumps;
    }
  EXPECT_GT(jumps, 0);
}

TEST(Jumps, FamiliesThatCrossArePassedInTheEnd) {
  // With the reversors in the equations, though not in the subspace, the index passes 2 at the crossing itself.
  const Followed held(test::pendulum(), in_phase_start(), true);
  EXPECT_EQ(held.ending.reason, continuation::EndReason::period_limit) << held.ending.text();
  ASSERT_EQ(held.passing_two().size(), 1U);
  EXPECT_GE(held.refused, 5);
  const std::size_t across = held.passing_two()[0];
  EXPECT_NEAR(held.orbits[across].loop.period, 10.416773281973249, 1e-6);
  // Down to the smallest jump, or to where the index is 2 within its error bound.
  EXPECT_LE(held.orbits[across].arclength - held.orbits[across - 1].arclength, 10.0 * Options{}.smallest_jump);
}

TEST(Jumps, IsToldFromTheIndexOnlyWhereNothingCanBreak) {
  const systems::Structure& pendulum = test::pendulum()->structure();
  EXPECT_TRUE(bifurcation::passes_two_only_at_folds(pendulum, without_reversors()));
  EXPECT_TRUE(bifurcation::passes_two_only_at_folds(pendulum, {}));
  EXPECT_FALSE(bifurcation::passes_two_only_at_folds(pendulum, test::pendulum_isotropy(*test::pendulum())));
  systems::Structure damped = pendulum;
  damped.symplectic = false;
  EXPECT_FALSE(bifurcation::passes_two_only_at_folds(damped, {}));
}

TEST(Jumps, ASenseOfRotationThatChangesUnseenIsOne) {
  const auto elliptic = [](double index, double twist) {
    spectrum::Stability out;
    out.full = out.fundamental = {index};
    out.full_error = out.fundamental_error = {1e-9};
    out.twist = twist;
    return out;
  };
  EXPECT_TRUE(bifurcation::passes_one_unseen(elliptic(1.5, 0.7), elliptic(1.9, -0.4)));
  EXPECT_FALSE(bifurcation::passes_one_unseen(elliptic(1.5, 0.7), elliptic(1.9, 0.4)));
  EXPECT_FALSE(bifurcation::passes_one_unseen(elliptic(-1.5, 0.7), elliptic(-1.9, -0.4))) << "nearer to -2";
  EXPECT_FALSE(bifurcation::passes_one_unseen(elliptic(1.5, 0.7), elliptic(2.1, -0.4))) << "not elliptic";
  EXPECT_FALSE(bifurcation::passes_one_unseen(elliptic(1.5, std::nan("")), elliptic(1.9, -0.4)));
}

TEST(Jumps, OfSeveralPairsEachIsAskedInItsOwnPlane) {
  // Pairs by index, and whether neighbours go around the other way: each in a plane of its own, turned by `turned`.
  struct Pair {
    double index;
    bool is_reversed;
  };
  const auto orbit = [](const std::vector<Pair>& pairs, double turned) {
    spectrum::Stability out;
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      out.fundamental.emplace_back(pairs[n].index);
      out.fundamental_error.push_back(1e-9);
      spectrum::Rotation rotation{std::acos(0.5 * pairs[n].index), {}};
      rotation.plane.setZero(6, 2);
      const auto q = static_cast<Eigen::Index>(2 * n);
      rotation.plane(q, 0) = std::cos(turned);
      rotation.plane((q + 2) % 6, 0) = std::sin(turned);
      rotation.plane(q + 1, 1) = pairs[n].is_reversed ? -1.0 : 1.0;
      out.rotations.push_back(rotation);
    }
    return out;
  };
  const auto first = orbit({{1.5, false}, {1.2, true}}, 0.0);
  EXPECT_FALSE(bifurcation::passes_one_unseen(first, orbit({{1.9, false}, {1.1, true}}, 0.3)));
  EXPECT_TRUE(bifurcation::passes_one_unseen(first, orbit({{1.9, true}, {1.1, true}}, 0.3)));
  EXPECT_TRUE(bifurcation::passes_one_unseen(first, orbit({{1.9, false}, {1.1, false}}, -0.3)));
  EXPECT_FALSE(bifurcation::passes_one_unseen(first, orbit({{1.9, false}, {-1.3, false}}, 0.3))) << "nearer to -2";
  const auto turned_far = orbit({{1.9, true}, {1.1, true}}, 1.3);
  EXPECT_FALSE(bifurcation::passes_one_unseen(first, turned_far)) << "planes too far apart";
  EXPECT_TRUE(bifurcation::TurningSense::is_untold(first, turned_far)) << "which a shorter step may tell";
  const auto one_left = orbit({{1.9, false}}, 0.3);
  EXPECT_FALSE(bifurcation::passes_one_unseen(first, one_left)) << "not elliptic";
  EXPECT_FALSE(bifurcation::TurningSense::is_untold(first, one_left)) << "one has left the circle, which signs show";
  EXPECT_FALSE(bifurcation::TurningSense::is_untold(orbit({{1.2, false}}, 0.0), orbit({{1.2, false}}, 1.3)))
      << "far from 1";
}

// Orbits of which neighbours go around by so many degrees.
TEST(FamilyJump, AnAngleThatChangesByMoreThanAQuarterOfATurnIsNotTrusted) {
  const auto rotating = [](double degrees) {
    spectrum::Stability out;
    const double angle = degrees * std::numbers::pi / 180.0;
    out.fundamental = {2.0 * std::cos(angle)};
    out.fundamental_error = {1e-10};
    out.twist = std::sin(angle);
    return out;
  };
  EXPECT_FALSE(bifurcation::rotates_too_far(rotating(200), rotating(280)));
  EXPECT_FALSE(bifurcation::rotates_too_far(rotating(280), rotating(200)));
  EXPECT_FALSE(bifurcation::rotates_too_far(rotating(170), rotating(210)));
  EXPECT_TRUE(bifurcation::rotates_too_far(rotating(200), rotating(353)));
  // l2 = 1000, In-Phase from T = 226.7 to 236.2: past 2 and past -2, so that the sense of turning is the same.
  EXPECT_TRUE(bifurcation::rotates_too_far(rotating(-6.5), rotating(229)));
  EXPECT_FALSE(bifurcation::passes_one_unseen(rotating(-6.5), rotating(229)));
  spectrum::Stability hyperbolic = rotating(0);
  hyperbolic.fundamental = {3.0};
  EXPECT_FALSE(bifurcation::rotates_too_far(rotating(200), hyperbolic));
}

// At k = 1e13 an index is between -2 and 2 on 4e-15 of a step of 0.01.
TEST(FamilyJump, TurnsAreNotAskedWhereAnIndexIsSteepBeyondAllSteps) {
  const auto of_index = [](double index) {
    spectrum::Stability out;
    out.fundamental = {index};
    return out;
  };
  const double smallest = Options{}.smallest_jump;
  EXPECT_TRUE(bifurcation::are_turns_asked(of_index(-1.0), of_index(3.0), 0.01, smallest));
  EXPECT_TRUE(bifurcation::are_turns_asked(of_index(-1e4), of_index(3.0), 0.01, smallest));
  EXPECT_FALSE(bifurcation::are_turns_asked(of_index(-1.3e13), of_index(3.0), 0.01, smallest));
  EXPECT_FALSE(bifurcation::are_turns_asked(of_index(1.0), of_index(3.8e15), 0.01, smallest));
  EXPECT_TRUE(bifurcation::are_turns_asked({}, {}, 0.01, smallest)) << "without indices";
}

TEST(FamilyJump, WholeTurnsAreNotTaken) {
  const auto turned = [](double turns, double index) {
    spectrum::Stability out;
    out.fundamental = {index};
    out.fundamental_error = {1e-10};
    out.twist = std::sin(2.0 * std::numbers::pi * turns);
    out.turns = turns;
    return out;
  };
  const auto elliptic = [&](double turns) { return turned(turns, 2.0 * std::cos(2.0 * std::numbers::pi * turns)); };
  EXPECT_FALSE(bifurcation::rotates_too_far(elliptic(707.3), elliptic(707.5)));
  EXPECT_TRUE(bifurcation::rotates_too_far(elliptic(707.3), elliptic(708.3)));
  EXPECT_TRUE(bifurcation::rotates_too_far(elliptic(707.3), elliptic(701.35)));
  EXPECT_FALSE(bifurcation::rotates_too_far(turned(3.0, 2.5), turned(3.5, -2.5)));
  EXPECT_FALSE(bifurcation::rotates_too_far(turned(3.0, 2.5), elliptic(3.4)));
  EXPECT_TRUE(bifurcation::rotates_too_far(turned(3.0, 2.5), turned(4.0, 2.5)));
}

/// The slow swing of a pendulum whose outer rod has this length, in steps that do not jump.
struct SlowSwing {
  std::shared_ptr<const systems::System> system;
  std::vector<spectrum::Stability> stabilities{};
  int passages = 0;
  continuation::Ending ending{};

  SlowSwing(double l2, double period, double start) : system(systems::make_system("double_pendulum", {{"l2", l2}})) {
    const double b = 2.0 * (1.0 + l2) / l2;  // of w^4 - b w^2 + 2/l2 = 0, m = l1 = g = 1
    const double square = 0.5 * (b - std::sqrt(b * b - 8.0 / l2));
    continuation::Start from;
    from.base = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * std::numbers::pi / std::sqrt(square), 10);
    from.direction.modes.assign(from.base.modes.size(), 0.0);
    from.direction.modes[4] = 1.0;
    from.direction.modes[5] = square / (1.0 - l2 * square);
    from.direction.modes[10] = -std::sqrt(square);
    from.direction.modes[11] = from.direction.modes[10] * from.direction.modes[5];
    from.isotropy = test::pendulum_isotropy(*system);
    Options plain;
    plain.period_limit = period;
    plain.start_amplitude = start;
    Options options = plain;
    const auto stability = [&](const Orbit& orbit) { return spectrum::floquet(*system, orbit.loop, from.isotropy); };
    options.jumped = [&](const Orbit& here, const Orbit& next) {
      return has_jumped(system, from.isotropy, plain, {here, stability(here)}, {next, stability(next)});
    };
    ending = continuation::trace(system, from, options, [&](const Orbit& orbit) {
      stabilities.push_back(stability(orbit));
      return true;
    });
    for (std::size_t n = 1; n < stabilities.size(); ++n)
      if (std::floor(stabilities[n].turns) != std::floor(stabilities[n - 1].turns)) ++passages;
  }
};

// Of the outer bob, which turns 71 times a half period and more often as it swings further: no gap that rounding shows.
TEST(FamilyJump, AFastPhaseThatPassesWholeTurnsDoesNotStopTheBranch) {
  const SlowSwing swing(1e-4, 6.4, 0.0087);
  EXPECT_EQ(swing.ending.reason, continuation::EndReason::period_limit) << swing.ending.text();
  EXPECT_EQ(swing.passages, 3);
  EXPECT_LT(swing.stabilities.size(), 50U) << "a step of 1e-7 at each passage would take thirty orbits more";
  for (std::size_t n = 1; n < swing.stabilities.size(); ++n)
    EXPECT_FALSE(bifurcation::rotates_too_far(swing.stabilities[n - 1], swing.stabilities[n]))
        << swing.stabilities[n - 1].turns << " to " << swing.stabilities[n].turns << " turns";
  // From another first orbit the same is passed, and the last one, at the same period, is the same.
  const SlowSwing other(1e-4, 6.4, 0.003);
  EXPECT_EQ(other.passages, swing.passages);
  EXPECT_NEAR(other.stabilities.back().turns, swing.stabilities.back().turns, 1e-5);
}

}  // namespace
}  // namespace family_jump_test
