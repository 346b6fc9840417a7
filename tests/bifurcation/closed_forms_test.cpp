#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "bifurcation/plane_family.hpp"
#include "bifurcation/sweep.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace closed_forms_test {
namespace {

using namespace orbweaver;
using bifurcation::Sector;
using bifurcation::TestFunction;
using Kind = TestFunction::Kind;
using test::PlaneFamily;

constexpr double pi = std::numbers::pi;
constexpr int subharmonics = 4;
constexpr int most_probes = 60;  // of the detector, three minima among them

struct Expected {
  TestFunction function;
  double position;
  bool tangency = false;
  bool genuine = true;
};
TestFunction sector(int q, int j) { return {Kind::sector, {q, j}}; }
constexpr TestFunction krein{Kind::krein, {}};
constexpr TestFunction torus{Kind::torus, {}};

std::vector<double> evenly(double from, double to, int intervals) {
  std::vector<double> positions;
  for (int n = 0; n <= intervals; ++n) positions.push_back(from + (to - from) * n / intervals);
  return positions;
}

void expect_events(std::vector<test::Event> found, std::vector<Expected> expected, double tolerance) {
  const auto by_position = [](const auto& a, const auto& b) { return a.position < b.position; };
  std::sort(found.begin(), found.end(), by_position);
  std::sort(expected.begin(), expected.end(), by_position);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    SCOPED_TRACE(testing::Message() << "event " << n << " at " << found[n].position);
    EXPECT_EQ(found[n].function, expected[n].function);
    EXPECT_NEAR(found[n].position, expected[n].position, expected[n].tangency ? 2e-5 : tolerance);
    EXPECT_EQ(found[n].tangency, expected[n].tangency);
    EXPECT_EQ(found[n].genuine, expected[n].genuine);
  }
}

spectrum::Stability stability_of(const PlaneFamily& system, double action) {
  const loop::Loop loop = system.circle(action);
  return spectrum::floquet(system, loop, loop::find_isotropy(system.structure(), loop, 1e-9));
}

/// Along the circles of a plane family, from one action to another in three step sizes.
void expect_along(const PlaneFamily& system, double from, double to, const std::vector<Expected>& expected) {
  const auto stability_at = [&](double action) { return stability_of(system, action); };
  const int order = stability_at(from).fundamental_order;
  const auto functions = bifurcation::test_functions(system.structure(), order, subharmonics);
  for (const int steps : {11, 37}) {
    SCOPED_TRACE(testing::Message() << steps << " steps");
    const test::Detection found =
        test::detect(system.structure(), stability_at, functions, evenly(from, to, steps), 1e-11);
    EXPECT_LE(found.probes, most_probes);
    expect_events(found.events, expected, 1e-9);
  }
}

Eigen::MatrixXd diagonal(std::initializer_list<double> entries) {
  const std::vector<double> values(entries);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())).asDiagonal();
}

TEST(ClosedForms, IndicesOfTwoFrequenciesAreWithinSmallBounds) {
  const PlaneFamily system({diagonal({0, 0, 0.2, 0.2}), diagonal({1, 1, 0, 0}), {}, {}});
  for (const double action : evenly(0.0501, 0.9501, 500)) {
    const spectrum::Stability stability = stability_of(system, action);
    std::vector<double> indices{2 * std::cos(2 * pi * action), 2 * std::cos(2 * pi * 0.2)};
    if (std::abs(indices[0]) < std::abs(indices[1])) std::swap(indices[0], indices[1]);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_LE(std::abs(stability.fundamental[n] - indices[n]), stability.fundamental_error[n]) << action;
      EXPECT_LE(stability.fundamental_error[n], 1e-11) << action;
    }
  }
}

TEST(ClosedForms, TwoFrequenciesPassEverySector) {
  // Indices 2 cos(2 pi I) and 2 cos(2 pi 0.2): q = 2 is touched, and the pairs meet without leaving the circle.
  const PlaneFamily system({diagonal({0, 0, 0.2, 0.2}), diagonal({1, 1, 0, 0}), {}, {}});
  expect_along(system, 0.05, 0.95,
               {{krein, 0.2, true, false},
                {sector(4, 1), 0.25},
                {sector(3, 1), 1.0 / 3.0},
                {sector(2, 1), 0.5, true},
                {sector(3, 1), 2.0 / 3.0},
                {sector(4, 1), 0.75},
                {krein, 0.8, true, false}});
}

TEST(ClosedForms, HalfMapHasSectorsOfItsOwn) {
  // Indices -2 cos(pi I) and -2 cos(pi 0.87) of the half map, -z being the orbit's other half.
  const PlaneFamily system({diagonal({0, 0, 0.87, 0.87}), diagonal({1, 1, 0, 0}), {}, {}}, true);
  expect_along(system, 0.05, 0.83,
               {{sector(8, 3), 0.25},
                {sector(3, 1), 1.0 / 3.0},
                {sector(4, 1), 0.5},
                {sector(6, 1), 2.0 / 3.0},
                {sector(8, 1), 0.75}});
}

TEST(ClosedForms, LostStabilityAtOnePassesOne) {
  // x'' = (I - 0.3) x: index 2 cos(2 pi sqrt(0.3 - I)), above I = 0.3 a hyperbolic cosine.
  const PlaneFamily system({diagonal({0.3, 1}), diagonal({-1, 0}), {}, {}});
  expect_along(system, 0.06, 0.5,
               {{sector(3, 1), 0.3 - 1.0 / 9.0}, {sector(4, 1), 0.3 - 1.0 / 16.0}, {sector(1, 0), 0.3}});
}

TEST(ClosedForms, SpringSwingsAtHalfItsFrequency) {
  // A swinging spring near its 1:2 resonance: frequency 1/2 + delta beside z_0, coupled by g Re(conj(z_0) z_1^2)/2; in
  // axes that turn half as fast as z_0 coefficients are constant, and the index is -2 cos(2 pi sqrt(delta^2 - 2 g^2
  // I)).
  const double delta = 0.2;
  const double g = 0.3;
  const Eigen::Matrix2d swap = (Eigen::Matrix2d() << 0, g, g, 0).finished();
  const PlaneFamily system({diagonal({0.5 + delta, 0.5 + delta}), {}, diagonal({g, -g}), swap});
  expect_along(
      system, 0.01, 0.6,
      {{sector(3, 1), (delta * delta - 1.0 / 36.0) / (2 * g * g)}, {sector(2, 1), delta * delta / (2 * g * g)}});
}

TEST(ClosedForms, PairsOfOppositeSignatureCollide) {
  // z_1 with frequency I, z_2 with -0.2, coupled by c Re(z_1 z_2): exponents -i lambda with
  // (lambda - I)(lambda - 0.2) + c^2 = 0, complex for |I - 0.2| < 2 c.
  const double c = 0.02;
  Eigen::MatrixXd constant = diagonal({0, 0, -0.2, -0.2});
  constant(0, 2) = constant(2, 0) = c;
  constant(1, 3) = constant(3, 1) = -c;
  const PlaneFamily system({constant, diagonal({1, 1, 0, 0}), {}, {}});
  expect_along(system, 0.05, 0.32, {{krein, 0.2 - 2 * c}, {krein, 0.2 + 2 * c}, {sector(4, 1), 0.25 + c * c / 0.05}});
}

TEST(ClosedForms, MeetingOffTheCircleIsNoKreinCollision) {
  // x_1'' = I x_1 - c x_2, x_2'' = c x_1 + 0.05 x_2, the second with negative kinetic energy: growth rates squared
  // meet at about 0.05 > 0.
  const double c = 0.005;
  Eigen::MatrixXd constant = diagonal({0, 1, 0.05, -1});
  constant(0, 2) = constant(2, 0) = c;
  const PlaneFamily system({constant, diagonal({-1, 0, 0, 0}), {}, {}});
  expect_along(system, 0.02, 0.08, {{krein, 0.05 - 2 * c, false, false}, {krein, 0.05 + 2 * c, false, false}});
}

template <class MakeStability>
void expect_for_parameters(const systems::Structure& structure, const MakeStability& stability_at, double from,
                           double to, const std::vector<Expected>& expected) {
  const auto functions = bifurcation::test_functions(structure, 1, subharmonics);
  for (const int steps : {11, 37}) {
    SCOPED_TRACE(testing::Message() << steps << " steps");
    const test::Detection found = test::detect(structure, stability_at, functions, evenly(from, to, steps), 1e-11);
    EXPECT_LE(found.probes, most_probes);
    expect_events(found.events, expected, 1e-9);
  }
}

TEST(ClosedForms, HopfCyclePassesOneSidewise) {
  // Multipliers exp(-4 pi 0.3) and exp(2 pi s), s the growth sidewise; their product is 1 at s = 0.6, both being real.
  const double growth = 0.3;
  loop::Loop loop = loop::constant_loop(std::vector<double>(3, 0.0), 2 * pi, 3);
  loop.cosine(1, 0) = loop.sine(1, 1) = std::sqrt(growth);
  const auto stability_at = [&](double s) { return spectrum::floquet(test::HopfCycle(growth, -s), loop, {}); };
  expect_for_parameters(test::HopfCycle(growth, 0.0).structure(), stability_at, -0.4, 0.9,
                        {{sector(1, 0), 0.0}, {torus, 0.6, false, false}});
}

TEST(ClosedForms, CycleWithATwistedBandDoublesItsPeriod) {
  // Multipliers -exp(2 pi (s +- 0.1)): each passes -1, and their product 1 in between.
  const auto stability_at = [](double s) {
    return spectrum::floquet(test::PlaneCycle(s, 0.1, 0.5), test::PlaneCycle::cycle(), {});
  };
  expect_for_parameters(test::PlaneCycle(0.0, 0.1, 0.5).structure(), stability_at, -0.33, 0.31,
                        {{sector(2, 1), -0.1}, {torus, 0.0, false, false}, {sector(2, 1), 0.1}});
}

TEST(ClosedForms, CycleWithATurningPlaneGrowsATorus) {
  // Multipliers of modulus exp(2 pi s), complex.
  for (const double d : {0.0, 0.1}) {
    const auto stability_at = [d](double s) {
      return spectrum::floquet(test::PlaneCycle(s, d, 0.2), test::PlaneCycle::cycle(), {});
    };
    expect_for_parameters(test::PlaneCycle(0.0, d, 0.2).structure(), stability_at, -0.33, 0.31, {{torus, 0.0}});
  }
}

}  // namespace
}  // namespace closed_forms_test
