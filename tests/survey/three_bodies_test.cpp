// The figure-eight of three bodies: its digits in the literature, the multipliers of all twelve coordinates, and what
// scaling and an exchange of bodies, of which the survey knows nothing, say of its families.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "systems/inertial_bodies.hpp"

namespace three_bodies_test {
namespace {

using namespace orbweaver;
using State12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

constexpr double known_period = 6.325913985;
constexpr double lost = 0.9998791097;  // m3 of the branch point, and of the fold
constexpr double fold = 1.000040301;

scene::Scene eight(const std::vector<std::string>& more) {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/three_bodies_figure_eight.yaml", more);
}

/// Both stability indices of an orbit of the archive.
std::vector<double> indices(const test::Atlas& atlas, std::size_t row) {
  const auto& stability = atlas.orbits().reals("stability");
  return {stability[4 * row], stability[4 * row + 2]};
}

std::vector<double> state_of(const test::Atlas& atlas, std::size_t row) {
  const auto first = atlas.orbits().reals("state").begin() + static_cast<std::ptrdiff_t>(6 * row);
  return {first, first + 6};
}

/// Of `family` the orbits with this value of the parameter.
std::vector<std::size_t> orbits_at(const test::Atlas& atlas, const std::string& family, double parameter) {
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[atlas.row_of(family)]);
  const std::vector<double> values = atlas.column("parameter", family);
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < values.size(); ++n)
    if (std::abs(values[n] - parameter) < 1e-12) rows.push_back(first + n);
  return rows;
}

/// Positions and velocities and what moves beside them: three equal masses.
struct Flow {
  State12 state;
  Matrix12 transition = Matrix12::Identity();
};

Flow rate(const Flow& at) {
  Flow change;
  change.state << at.state.tail<6>(), Eigen::Matrix<double, 6, 1>::Zero();
  Matrix12 jacobian = Matrix12::Zero();
  jacobian.topRightCorner<6, 6>().setIdentity();
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < 3; ++l) {
      if (l == i) continue;
      const Eigen::Vector2d way = at.state.segment<2>(2 * l) - at.state.segment<2>(2 * i);
      const double r = way.norm();
      change.state.segment<2>(6 + 2 * i) += way / (r * r * r);
      const Eigen::Matrix2d tide =
          Eigen::Matrix2d::Identity() / (r * r * r) - 3.0 * way * way.transpose() / std::pow(r, 5);
      jacobian.block<2, 2>(6 + 2 * i, 2 * l) += tide;
      jacobian.block<2, 2>(6 + 2 * i, 2 * i) -= tide;
    }
  change.transition = jacobian * at.transition;
  return change;
}

/// By the classical Runge-Kutta method; 20000 steps leave some 1e-11.
Flow after(Flow at, double time) {
  constexpr int steps = 20000;
  const double h = time / steps;
  const auto moved = [](const Flow& from, const Flow& by, double factor) {
    return Flow{from.state + factor * by.state, from.transition + factor * by.transition};
  };
  for (int n = 0; n < steps; ++n) {
    const Flow a = rate(at);
    const Flow b = rate(moved(at, a, h / 2));
    const Flow c = rate(moved(at, b, h / 2));
    const Flow d = rate(moved(at, c, h));
    at = moved(moved(moved(moved(at, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
  }
  return at;
}

// Of twelve multipliers eight are 1: two each for the energy, the angular momentum and both momenta.
void expect_two_pairs_of_twelve(const std::vector<double>& state, double period, const std::vector<double>& k) {
  const test::Inertial bodies = test::inertial({{"m1", 1.0}, {"m2", 1.0}, {"m3", 1.0}, {"L", 0.0}}, state, 0.4);
  Flow start;
  start.state << bodies.x[0], bodies.x[1], bodies.x[2], bodies.v[0], bodies.v[1], bodies.v[2];
  const Flow end = after(start, period);
  EXPECT_LT((end.state - start.state).norm(), 1e-8) << "nothing has turned: the eight closes where it was";
  EXPECT_NEAR(end.transition.trace(), 8.0 + k[0] + k[1], 1e-6);
  EXPECT_NEAR((end.transition * end.transition).trace(), 8.0 + k[0] * k[0] - 2.0 + k[1] * k[1] - 2.0, 1e-6);
}

TEST(ThreeBodies, TheFigureEightHasItsKnownDigits) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, eight({"survey.depth=0", "limits.parameter=[0.9997, 1.1]"}), "eight");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const std::vector<std::size_t> rows = orbits_at(atlas, "Eight", 1.0);
  ASSERT_EQ(rows.size(), 1U);
  const std::size_t row = rows.front();
  EXPECT_NEAR(atlas.orbits().reals("period")[row], known_period, 1e-14);
  // Simo 2002: the multipliers are exp(2 pi i nu).
  const std::vector<double> k = indices(atlas, row);
  EXPECT_NEAR(std::acos(0.5 * k[0]) / (2.0 * std::numbers::pi), 0.00842272, 1e-8);
  EXPECT_NEAR(std::acos(0.5 * k[1]) / (2.0 * std::numbers::pi), 0.29809253, 1e-8);
  expect_two_pairs_of_twelve(state_of(atlas, row), known_period, k);
  EXPECT_EQ(atlas.crossings().rows(), 2U);
}

// Lengths by c^2 and times by c^3 make orbits of orbits: at a fixed energy the same happens at the same masses.
TEST(ThreeBodies, FamiliesAtAFixedPeriodAndAtAFixedEnergyAreTheSame) {
  const core::Communicator comm;
  for (const std::string hold : {"period", "energy"}) {
    SCOPED_TRACE(hold);
    const survey::Summary summary =
        test::run(comm, eight({"survey.depth=0", "continuation.hold=" + hold, "limits.parameter=[0.9997, 1.1]"}), hold);
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    const test::Atlas atlas(summary.atlas);
    const std::vector<std::size_t> rows = orbits_at(atlas, "Eight", 1.0);
    ASSERT_EQ(rows.size(), 1U);
    // The energy is that of the start, which has nine digits.
    EXPECT_NEAR(atlas.orbits().reals("period")[rows.front()], known_period, 1e-7);
    for (const double energy : atlas.column("energy", "Eight"))
      EXPECT_TRUE(hold == "period" || std::abs(energy - atlas.orbits().reals("energy")[rows.front()]) < 1e-12)
          << energy;
    const auto& kinds = atlas.crossings().texts("kind");
    ASSERT_EQ(kinds, (std::vector<std::string>{"branch-point", "fold-parameter"}));
    EXPECT_NEAR(atlas.crossings().reals("parameter")[0], lost, 1e-10);
    EXPECT_NEAR(atlas.crossings().reals("parameter")[1], fold, 1e-9);
  }
}

// Behind the fold the family comes back to equal masses with an orbit on which only two bodies run along like curves.
// With the bodies exchanged it lies on the family that leaves at the branch point, which has no reversor here.
TEST(ThreeBodies, ExchangedBodiesHaveTheSameOrbit) {
  const core::Communicator comm;
  const survey::Summary behind = test::run(comm, eight({"survey.depth=0", "limits.parameter=[1, 1.1]"}), "behind");
  const survey::Summary beside = test::run(
      comm, eight({"system.parameters.m3=0.99995", "limits.parameter=[0.9998, 1]", "survey.depth=1"}), "beside");
  const survey::Verification verified = survey::verify(comm, beside.atlas);
  if (!comm.is_root()) return;
  EXPECT_EQ(behind.failures + beside.failures, 0U);
  for (const survey::Objection& o : verified.objections) ADD_FAILURE() << o.table << " " << o.row << ": " << o.text;
  const test::Atlas first(behind.atlas);
  const test::Atlas second(beside.atlas);
  const std::vector<std::size_t> here = orbits_at(first, "Eight", 1.0);
  const std::vector<std::size_t> there = orbits_at(second, "Eight B", 1.0);
  ASSERT_EQ(here.size(), 2U);
  ASSERT_EQ(there.size(), 1U);
  EXPECT_EQ(second.families().texts("isotropy")[second.row_of("Eight B")], "Y@1/2");
  EXPECT_GT(std::abs(first.orbits().reals("energy")[here[0]] - first.orbits().reals("energy")[here[1]]), 1e-8);
  for (const std::string column : {"energy", "action"})
    EXPECT_NEAR(first.orbits().reals(column)[here[1]], second.orbits().reals(column)[there[0]], 1e-10) << column;
  for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(indices(first, here[1])[n], indices(second, there[0])[n], 1e-8);
  expect_two_pairs_of_twelve(state_of(second, there[0]), known_period, indices(second, there[0]));
}

// The frame's rate is dH/dL: it differs from place to place along an orbit, and so do the energies by L alone.
TEST(ThreeBodies, EightsThatTurnHoldTheirEnergy) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      eight({"survey.depth=0", "continuation.free=L", "continuation.hold=energy", "limits.parameter=[-0.05, 0.05]"}),
      "turning");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const std::vector<double> energies = atlas.column("energy", "Eight");
  for (const double energy : energies) EXPECT_NEAR(energy, energies.front(), 1e-12);
  // A mirror image turns the other way round.
  const std::vector<double> periods = atlas.column("period", "Eight");
  const std::vector<double> momenta = atlas.column("parameter", "Eight");
  EXPECT_NEAR(momenta.front(), -0.05, 1e-12);
  EXPECT_NEAR(momenta.back(), 0.05, 1e-12);
  EXPECT_NEAR(periods.front(), periods.back(), 1e-9);
  EXPECT_LT(periods.front(), known_period - 1e-3);
}

}  // namespace
}  // namespace three_bodies_test
