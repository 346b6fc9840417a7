// Surveys of systems that conserve a momentum beside the energy: against the same systems with it taken out by hand,
// the multipliers of all coordinates, and periods by quadrature.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mpi.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/lattice.hpp"
#include "survey/atlas.hpp"
#include "survey/same_tree.hpp"

namespace several_quantities_test {
namespace {

using namespace orbweaver;
using testing::HasSubstr;

scene::Scene scene_of(const std::string& system, const std::vector<std::string>& more) {
  systems::add_recorded<test::Lattice>();
  systems::add_recorded<test::LatticeByHand>();
  systems::add_recorded<test::CentralField>();
  std::vector<std::string> all{"system.name=" + system, "starts.fixed_points.names={}",
                               "starts.fixed_points.letters={}", "starts.sweep.period=auto"};
  all.insert(all.end(), more.begin(), more.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
}

void expect_verified(const core::Communicator& comm, const survey::Summary& summary) {
  const survey::Verification verified = survey::verify(comm, summary.atlas);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << (summary.failed_tasks.empty() ? "" : summary.failed_tasks.front());
  for (const survey::Objection& o : verified.objections) ADD_FAILURE() << o.table << " " << o.row << ": " << o.text;
}

/// Of both lattices, a ring or a chain: the same families with the same crossings, and nothing at the multipliers that
/// the momentum has.
void expect_that_of_by_hand(const std::string& name, const std::vector<std::string>& more) {
  const core::Communicator comm;
  const survey::Summary told = test::run(comm, scene_of("lattice", more), name);
  const survey::Summary by_hand = test::run(comm, scene_of("lattice_by_hand", more), name + "_by_hand");
  expect_verified(comm, told);
  if (!comm.is_root()) return;
  EXPECT_EQ(by_hand.failures, 0U);
  EXPECT_GT(told.families.size(), 2U);
  const test::Atlas a(told.atlas);
  EXPECT_GT(a.crossings().rows(), 2U);
  test::expect_same_tree(a, test::Atlas(by_hand.atlas));
}

TEST(SeveralQuantities, ARingHasTheTreeOfTheRingWithoutItsCentre) {
  expect_that_of_by_hand(
      "ring", {"system.parameters={a: 1}", "limits.energy=[-.inf, 8.0]", "limits.period=14", "survey.subharmonics=2"});
}

TEST(SeveralQuantities, AChainHasTheTreeOfTheChainWithoutItsCentre) {
  expect_that_of_by_hand("chain", {"system.parameters={a: 1, closing: 0}", "limits.energy=[-.inf, 30.0]",
                                   "limits.period=14", "survey.subharmonics=2"});
}

using State6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct Flow {
  State6 state;
  Matrix6 transition = Matrix6::Identity();
};

/// By the classical Runge-Kutta method; 4000 steps leave some 1e-11.
Flow after(const systems::System& whole, Flow at, double time) {
  constexpr int steps = 4000;
  const double h = time / steps;
  const auto rate = [&](const Flow& from) {
    Flow change;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> jacobian;
    whole.field_jacobian(1, from.state.data(), change.state.data(), jacobian.data());
    change.transition = jacobian * from.transition;
    return change;
  };
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

// At the momentum P the lattice of mass M goes P T/M further in a period. Of six multipliers four are 1.
TEST(SeveralQuantities, FourOfSixMultipliersAreTheTrivialOnes) {
  const core::Communicator comm;
  for (const double momentum : {0.0, 0.9}) {
    const std::map<std::string, double> parameters{{"closing", 0.0}, {"m2", 2.5}, {"momentum", momentum}};
    const survey::Summary summary = test::run(
        comm,
        scene_of("lattice", {"system.parameters={closing: 0, m2: 2.5, momentum: " + std::to_string(momentum) + "}",
                             "survey.depth=0", "limits.energy=[-.inf, 3.0]"}),
        momentum == 0.0 ? "at_rest" : "going");
    expect_verified(comm, summary);
    if (!comm.is_root()) continue;
    const auto told = systems::make_system("lattice", parameters);
    const test::Atlas atlas(summary.atlas);
    ASSERT_EQ(atlas.families().rows(), 2U);
    for (const std::string& family : atlas.families().texts("name")) {
      const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[atlas.row_of(family)]);
      const std::size_t row = first + atlas.column("period", family).size() / 2;
      const double period = atlas.orbits().reals("period")[row];
      const auto state = atlas.orbits().reals("state").begin() + static_cast<std::ptrdiff_t>(4 * row);
      const std::vector<double> z = systems::whole_state(*told, std::vector<double>(state, state + 4));
      Flow start;
      start.state = Eigen::Map<const State6>(z.data());
      const Flow end = after(*systems::whole_of(*told), start, period);
      State6 drift = State6::Zero();
      drift.head<3>().setConstant(momentum * period / 4.5);
      EXPECT_LT((end.state - start.state - drift).norm(), 1e-9) << family;
      EXPECT_NEAR(end.transition.trace(), 4.0 + atlas.orbits().reals("stability")[row], 1e-8) << family;
    }
  }
}

/// The period of r around a circular orbit, b = 1: with u = r^2 and its turning points u1 < u2, u' = 2 r pr and
///   u'^2/4 = 2 E u - u^2 - u^3/2 - L^2 = (u - u1)(u2 - u)(u - u3)/2.
double radial_period(double energy, double momentum, double turning_point) {
  const double u1 = turning_point * turning_point;
  // The other two are those of u^2/2 + c u - L^2/u1.
  const double c = 1.0 + 0.5 * u1;
  const double root = std::sqrt(c * c + 2.0 * momentum * momentum / u1);
  const double u2 = root - c;
  const double u3 = -root - c;
  const double square = momentum * momentum;
  EXPECT_NEAR(2.0 * energy * u2 - u2 * u2 - 0.5 * u2 * u2 * u2, square, 1e-11 * (1.0 + square));
  constexpr int nodes = 200;
  double sum = 0.0;
  for (int n = 0; n < nodes; ++n) {
    const double u = 0.5 * (u1 + u2) + 0.5 * (u2 - u1) * std::cos(std::numbers::pi * (n + 0.5) / nodes);
    sum += 1.0 / std::sqrt(0.5 * (u - u3));
  }
  return std::numbers::pi * sum / nodes;
}

void expect_radial_periods(const test::Atlas& atlas, bool moves) {
  EXPECT_GT(atlas.orbits().rows(), 10U);
  const auto& states = atlas.orbits().reals("state");
  for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
    EXPECT_NEAR(states[2 * row + 1], 0.0, 1e-9);
    const double momentum = moves ? atlas.orbits().reals("parameter")[row] : 1.0;
    const double period = atlas.orbits().reals("period")[row];
    EXPECT_NEAR(period, radial_period(atlas.orbits().reals("energy")[row], momentum, states[2 * row]), 1e-9 * period)
        << "L = " << momentum;
  }
}

TEST(SeveralQuantities, ParticlesInACentralFieldCloseButForATurn) {
  const core::Communicator comm;
  const std::vector<std::string> circular{"starts.fixed_points.grid=[[0.8], [0]]", "limits.energy=[-.inf, 6.0]"};
  const survey::Summary summary = test::run(comm, scene_of("central_field", circular), "field");
  expect_verified(comm, summary);
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.families().rows(), 1U);
  EXPECT_EQ(atlas.crossings().rows(), 0U);
  expect_radial_periods(atlas, false);
}

// The value that is held is a parameter like any other; a start may be told in all coordinates.
TEST(SeveralQuantities, TheAngularMomentumMovesAlongAFamily) {
  const core::Communicator comm;
  const std::vector<std::string> at_fixed_energy{
      "starts={states: [{state: [1.2, 40, 0, 1], period: 2.4, name: Turning}]}", "continuation={free: L, hold: energy}",
      "limits.parameter=[0.5, 1.4]", "limits.energy=[-.inf, 6]"};
  const survey::Summary summary = test::run(comm, scene_of("central_field", at_fixed_energy), "moving");
  expect_verified(comm, summary);
  if (comm.is_root()) {
    const test::Atlas atlas(summary.atlas);
    ASSERT_EQ(atlas.families().rows(), 1U);
    expect_radial_periods(atlas, true);
  }
  std::vector<std::string> other = at_fixed_energy;
  other[0] = "starts={states: [{state: [1.2, 40, 0, 1.1], period: 2.4, name: Turning}]}";
  try {
    static_cast<void>(scene_of("central_field", other));
    ADD_FAILURE() << "taken";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected a state with L = 1, which is held, got one with 1.1"));
  }
}

// A table of all coordinates: the chain's outer particles swing against one another, seen from a place of its own.
TEST(SeveralQuantities, LoopsMayBeToldInAllCoordinates) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder("table" + std::to_string(comm.size()), comm.get());
  const auto file = std::filesystem::absolute(folder / "loop.csv");
  if (comm.is_root()) {
    std::ofstream table(file);
    table << "t,p1,p2,p3,x1,x2,x3\n";
    constexpr int rows = 24;
    for (int n = 0; n < rows; ++n) {
      const double t = 2.0 * std::numbers::pi * n / rows;  // of x'' = -x - x^2/4 - x^3, to first order
      const double x = 0.2 * std::cos(t), p = 0.2 * std::sin(t);
      table << t * 6.1955 / (2.0 * std::numbers::pi) << "," << p << ",0," << -p << ","  // p1, p2, p3
            << 7.0 - x << ",7," << 7.0 + x << "\n";
    }
  }
  MPI_Barrier(comm.get());
  const survey::Summary summary =
      test::run(comm,
                scene_of("lattice", {"system.parameters={closing: 0}", "survey.depth=0", "limits.energy=[-.inf, 1]",
                                     "starts={loops: [{file: " + file.string() + ", period: 6.1955}]}"}),
                "from_table");
  expect_verified(comm, summary);
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.families().rows(), 1U);
  // T = 2 pi (1 - (3/8 - 5/192) A^2) to second order, E = A^2.
  const std::vector<double> periods = atlas.orbits().reals("period");
  const auto at = std::find_if(periods.begin(), periods.end(), [](double t) { return std::abs(t - 6.1955) < 1e-9; });
  ASSERT_NE(at, periods.end());
  EXPECT_NEAR(atlas.orbits().reals("energy")[static_cast<std::size_t>(at - periods.begin())], 0.04, 0.004);
}

}  // namespace
}  // namespace several_quantities_test
