#include "orbweaver/spectrum/floquet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/floquet_checks.hpp"
#include "spectrum/pendulum_loops.hpp"
#include "spectrum/point_systems.hpp"
#include "support/relative_error.hpp"

namespace floquet_test {
namespace {

using namespace orbweaver;
using spectrum::floquet;
using spectrum::Stability;
using test::expect_value;

constexpr double pi = std::numbers::pi;

/// q_0 = cos t, p_0 = -sin t, all else zero: an orbit of `Oscillators` with stiffness_0 = 1.
loop::Loop first_oscillation(int dimension, int cutoff = 3) {
  loop::Loop loop = loop::constant_loop(std::vector<double>(static_cast<std::size_t>(dimension), 0.0), 2 * pi, cutoff);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 1) = -1.0;
  return loop;
}

loop::Isotropy isotropy_of(const systems::System& system, const loop::Loop& loop) {
  return loop::find_isotropy(system.structure(), loop, 1e-9);
}

// --- by pencil ---

TEST(Floquet, HarmonicOscillatorHasNoIndex) {
  const auto system = systems::make_system("harmonic_oscillator");
  const loop::Loop loop = first_oscillation(2);
  const Stability stability = floquet(*system, loop, isotropy_of(*system, loop));
  EXPECT_TRUE(stability.full.empty());
  EXPECT_TRUE(stability.fundamental.empty());
  EXPECT_EQ(stability.fundamental_order, 2);
  EXPECT_EQ(test::relative_error(stability), 0.0);
}

TEST(Floquet, SecondOscillatorTurnsByItsFrequency) {
  for (const double omega : {0.3, 1.7, 9.4}) {
    const test::Oscillators system({1.0, omega * omega});
    const loop::Loop loop = first_oscillation(4);
    const Stability whole = floquet(system, loop, {});
    ASSERT_EQ(whole.full.size(), 1u);
    EXPECT_EQ(whole.fundamental_order, 1);
    expect_value(whole.full[0], whole.full_error[0], 2.0 * std::cos(2 * pi * omega), 1e-11);
    const Stability half = floquet(system, loop, isotropy_of(system, loop));
    EXPECT_EQ(half.fundamental_order, 2);
    expect_value(half.full[0], half.full_error[0], 2.0 * std::cos(2 * pi * omega), 1e-11);
    expect_value(half.fundamental[0], half.fundamental_error[0], -2.0 * std::cos(pi * omega), 1e-11);
  }
}

// q goes towards -p: by 108 degrees in the second plane, and in the third by 234, which is 126 the other way.
TEST(Floquet, EachOfSeveralPairsGoesAroundInItsPlane) {
  const test::Oscillators system({1.0, 0.3 * 0.3, 0.65 * 0.65, 1.25 * 1.25});
  const Stability stability = floquet(system, first_oscillation(8), {});
  EXPECT_TRUE(std::isnan(stability.twist));
  ASSERT_EQ(stability.rotations.size(), 3u);
  const auto rotation_of = [&](Eigen::Index coordinate) {
    for (const spectrum::Rotation& rotation : stability.rotations) {
      const double overlap = rotation.plane.middleRows(coordinate, 2).determinant();
      if (std::abs(overlap) > 0.5) return std::pair(rotation.angle, overlap);
    }
    return std::pair(0.0, 0.0);
  };
  const std::vector<double> angles{0.6 * pi, 0.7 * pi, 0.5 * pi};
  const std::vector<double> senses{-1.0, 1.0, -1.0};
  for (const std::size_t n : {0u, 1u, 2u}) {
    const auto [angle, overlap] = rotation_of(static_cast<Eigen::Index>(2 * n + 2));
    EXPECT_NEAR(angle, angles[n], 1e-10);
    EXPECT_NEAR(overlap, senses[n], 1e-10);
  }
}

TEST(Floquet, APairThatIsNotOnTheUnitCircleHasNoPlane) {
  const test::Oscillators system({1.0, 0.3 * 0.3, -0.2 * 0.2});
  const Stability stability = floquet(system, first_oscillation(6), {});
  ASSERT_EQ(stability.rotations.size(), 1u);
  EXPECT_NEAR(stability.rotations[0].angle, 0.6 * pi, 1e-10);
  EXPECT_TRUE(floquet(test::Oscillators({1.0, 0.3 * 0.3}), first_oscillation(4), {}).rotations.empty()) << "one pair";
}

/// A particle in the plane under the force -(1 + r^2) q, state x, y, px, py; a half turn S and a third of a turn C are
/// declared. On the circle r = a it turns at w^2 = 1 + a^2, and oscillates across it at v^2 = 4 + 6 a^2.
class RoundBowl final : public test::PointSystem {
 public:
  RoundBowl() : PointSystem(described()) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::Vector4d g = gradient_at(z);
    return Eigen::Vector4d(g(2), g(3), -g(0), -g(1));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const Eigen::Vector2d q = z.head<2>();
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a.topRightCorner<2, 2>().setIdentity();
    a.bottomLeftCorner<2, 2>() = -(1.0 + q.squaredNorm()) * Eigen::Matrix2d::Identity() - 2.0 * q * q.transpose();
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    Eigen::Vector4d g = z;
    g.head<2>() *= 1.0 + z.head<2>().squaredNorm();
    return g;
  }
  [[nodiscard]] static loop::Loop circle(double radius) {
    const double turning = std::sqrt(1.0 + radius * radius);
    loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), 2 * pi / turning, 3);
    loop.cosine(1, 0) = loop.sine(1, 1) = radius;
    loop.sine(1, 2) = -radius * turning;
    loop.cosine(1, 3) = radius * turning;
    return loop;
  }

 private:
  static systems::Structure described() {
    systems::Structure structure = test::structure_of(4, true, true);
    const double c = std::cos(2 * pi / 3);
    const double s = std::sin(2 * pi / 3);
    Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
    turn.topLeftCorner<2, 2>() << c, -s, s, c;
    turn.bottomRightCorner<2, 2>() = turn.topLeftCorner<2, 2>();
    structure.equivariances = {{"S", -Eigen::Matrix4d::Identity()}, {"C", turn}};
    return structure;
  }
};

TEST(Floquet, TheLeastShiftIsThatOfAProduct) {
  const RoundBowl system;
  for (const double radius : {0.4, 1.3}) {
    const loop::Loop loop = RoundBowl::circle(radius);
    const loop::Isotropy isotropy = isotropy_of(system, loop);
    EXPECT_EQ(loop::to_text(isotropy), "S@1/2 C@1/3");
    EXPECT_EQ(loop::fundamental_domain(system.structure(), isotropy).order, 6);
    const Stability stability = floquet(system, loop, isotropy);
    EXPECT_EQ(stability.fundamental_order, 6);
    const double phase = loop.period * std::sqrt(4.0 + 6.0 * radius * radius);
    EXPECT_NEAR(stability.full[0].real(), 2.0 * std::cos(phase), 1e-10);
    EXPECT_NEAR(stability.fundamental[0].real(), 2.0 * std::cos(phase / 6.0), 1e-11);
  }
}

// All segments of a circle are alike, and so are their errors, whose direction is not that of their estimates.
TEST(Floquet, BoundsHoldWhereAllSegmentsAreAlike) {
  const RoundBowl system;
  for (const double radius : {0.1, 0.4, 0.8, 1.3, 2.0, 3.0, 5.0}) {
    const loop::Loop loop = RoundBowl::circle(radius);
    const double phase = loop.period * std::sqrt(4.0 + 6.0 * radius * radius);
    for (const loop::Isotropy& isotropy : {loop::Isotropy{}, isotropy_of(system, loop)})
      for (const int segments : {48, 96}) {
        spectrum::FloquetOptions options;
        options.least_segments = segments;
        const Stability stability = floquet(system, loop, isotropy, options);
        const double fundamental = 2.0 * std::cos(phase / stability.fundamental_order);
        EXPECT_LE(std::abs(stability.full[0] - 2.0 * std::cos(phase)), stability.full_error[0]) << radius;
        EXPECT_LE(std::abs(stability.fundamental[0] - fundamental), stability.fundamental_error[0]) << radius;
        EXPECT_LE(stability.fundamental_error[0], 1e-9) << "the bound says nothing";
      }
  }
}

TEST(Floquet, LargeAndSmallIndicesKeepTheirDigitsSideBySide) {
  const double growth = 6.2;
  const double omega = 0.37;
  const test::Oscillators system({1.0, -growth * growth, omega * omega, -0.04});
  const loop::Loop loop = first_oscillation(8);
  for (const loop::Isotropy& isotropy : {loop::Isotropy{}, isotropy_of(system, loop)}) {
    const Stability stability = floquet(system, loop, isotropy);
    ASSERT_EQ(stability.full.size(), 3u);
    expect_value(stability.full[0], stability.full_error[0], 2.0 * std::cosh(2 * pi * growth), 1e-10);
    expect_value(stability.full[1], stability.full_error[1], 2.0 * std::cosh(2 * pi * 0.2), 1e-11);
    expect_value(stability.full[2], stability.full_error[2], 2.0 * std::cos(2 * pi * omega), 1e-11);
    EXPECT_GT(std::abs(stability.full[0]), 1e16);
  }
}

TEST(Floquet, AnIndexBeyondRangeLeavesTheOthers) {
  const double omega = 0.37;
  const test::Oscillators system({1.0, -120.0 * 120.0, omega * omega, -0.04});
  const loop::Loop loop = first_oscillation(8);
  const Stability stability = floquet(system, loop, {});
  ASSERT_EQ(stability.full.size(), 3u);
  EXPECT_TRUE(std::isnan(stability.full[0].real())) << "2 cosh(240 pi) is 1e327";
  EXPECT_TRUE(std::isnan(stability.full_error[0]));
  EXPECT_NEAR(stability.full[1].real(), 2.0 * std::cosh(2 * pi * 0.2), stability.full_error[1]);
  EXPECT_NEAR(stability.full[2].real(), 2.0 * std::cos(2 * pi * omega), stability.full_error[2]);
  EXPECT_LT(stability.full_error[1] + stability.full_error[2], 1e-4) << "beside 1e327";
}

TEST(Floquet, EqualPairsOfTheHalfMapHaveIndicesOfTheirOwn) {
  const double omega = 0.37;
  const test::Oscillators system({1.0, omega * omega, omega * omega});
  const loop::Loop loop = first_oscillation(6);
  const Stability stability = floquet(system, loop, isotropy_of(system, loop));
  ASSERT_EQ(stability.fundamental.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    expect_value(stability.fundamental[n], stability.fundamental_error[n], -2.0 * std::cos(pi * omega), 1e-11);
    expect_value(stability.full[n], stability.full_error[n], 2.0 * std::cos(2 * pi * omega), 1e-11);
  }
}

TEST(Floquet, HopfCycleContractsAsItsNormalForm) {
  const double growth = 0.3;
  const double decay = 6.0;
  const test::HopfCycle system(growth, decay);
  loop::Loop loop = loop::constant_loop(std::vector<double>(3, 0.0), 2 * pi, 3);
  loop.cosine(1, 0) = std::sqrt(growth);
  loop.sine(1, 1) = std::sqrt(growth);
  const loop::Isotropy isotropy = isotropy_of(system, loop);
  ASSERT_EQ(loop::to_text(isotropy), "S@1/2");
  for (const bool symmetric : {false, true}) {
    const Stability stability = floquet(system, loop, symmetric ? isotropy : loop::Isotropy{});
    ASSERT_EQ(stability.full.size(), 2u);
    expect_value(stability.full[0], stability.full_error[0], std::exp(-4 * pi * growth), 1e-11);
    expect_value(stability.full[1], stability.full_error[1], std::exp(-2 * pi * decay), 1e-10);
    if (symmetric)
      expect_value(stability.fundamental[0], stability.fundamental_error[0], std::exp(-2 * pi * growth), 1e-11);
    EXPECT_EQ(stability.fundamental_order, symmetric ? 2 : 1);
  }
}

TEST(Floquet, ConservedEnergyWithoutSymplecticFormGivesAnExactOne) {
  const test::SymmetricTop system(0.8);
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0, 1.25}, 2 * pi, 3);
  loop.cosine(1, 0) = 0.4;
  loop.sine(1, 1) = 0.4;
  const Stability stability = floquet(system, loop, {});
  ASSERT_EQ(stability.full.size(), 2u);
  expect_value(stability.full[0], stability.full_error[0], 1.0, 1e-12);
  EXPECT_EQ(stability.full[1], 1.0);
}

// --- small oscillations ---

// About 0 nothing but an orbit's last digits is rounding, however small it is. With m2 = 9/16 the frequencies are
// sqrt(5/8) and sqrt(5/2), and the slow oscillation's index is 2.
TEST(Floquet, BoundsSayMuchOfTinyOrbitsAboutZero) {
  struct Case {
    double m2;
    test::PendulumMode mode;
    double index;
  };
  const test::PendulumMode slow{"slow", {0, 0, 0, 0}, std::sqrt(0.625), 5.0 / 3.0};
  for (const Case& with : {Case{1.0, test::in_phase(), 2.0 * std::cos(2 * pi * (1.0 + std::numbers::sqrt2))},
                           Case{0.5625, slow, 2.0}}) {
    const auto system = systems::make_system("double_pendulum", {{"m2", with.m2}});
    for (const double amplitude : {1e-6, 1e-8, 1e-10}) {
      const Stability stability = floquet(*system, test::linear_loop(with.mode, amplitude, 3), {});
      ASSERT_EQ(stability.full.size(), 1u);
      EXPECT_LE(std::abs(stability.full[0] - with.index), stability.full_error[0]) << with.m2 << ", " << amplitude;
      EXPECT_LE(stability.full_error[0], 1e-9) << with.m2 << ", " << amplitude;
    }
  }
}

// --- Henon and Heiles ---

using Long = long double;

/// x, y, px, py and the transition matrix row by row.
using HenonState = std::array<Long, 20>;

HenonState henon_slope(const HenonState& s) {
  HenonState k{};
  k[0] = s[2];
  k[1] = s[3];
  k[2] = -s[0] - 2 * s[0] * s[1];
  k[3] = s[1] * s[1] - s[0] * s[0] - s[1];
  for (std::size_t b = 0; b < 4; ++b) {
    k[4 + b] = s[12 + b];
    k[8 + b] = s[16 + b];
    k[12 + b] = -(1 + 2 * s[1]) * s[4 + b] - 2 * s[0] * s[8 + b];
    k[16 + b] = -2 * s[0] * s[4 + b] + (2 * s[1] - 1) * s[8 + b];
  }
  return k;
}

HenonState plus(const HenonState& a, Long h, const HenonState& b) {
  HenonState sum{};
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] = a[n] + h * b[n];
  return sum;
}

/// The classical Runge-Kutta method in long double.
HenonState henon_flow(HenonState s, Long time, int steps) {
  const Long h = time / steps;
  for (int n = 0; n < steps; ++n) {
    const HenonState a = henon_slope(s);
    const HenonState b = henon_slope(plus(s, h / 2, a));
    const HenonState c = henon_slope(plus(s, h / 2, b));
    const HenonState d = henon_slope(plus(s, h, c));
    for (std::size_t i = 0; i < s.size(); ++i) s[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return s;
}

/// k by direct integration, once around: the trace less the two trivial multipliers.
double henon_index(const loop::Loop& loop) {
  const std::vector<double> start = loop::state_at(loop, 0.0);
  HenonState s{};
  for (std::size_t i = 0; i < 4; ++i) {
    s[i] = static_cast<Long>(start[i]);
    s[4 + 5 * i] = 1;
  }
  s = henon_flow(s, static_cast<Long>(loop.period), 40000);
  return static_cast<double>(s[4] + s[9] + s[14] + s[19] - 2);
}

/// The straight orbits along the mirror axis x = 0.
std::vector<loop::Loop> henon_orbits(const std::shared_ptr<const systems::System>& system) {
  continuation::Start start;
  start.base = loop::constant_loop(std::vector<double>(4, 0.0), 2 * pi, 8);
  loop::Loop direction = start.base;
  direction.cosine(1, 1) = 1.0;
  direction.sine(1, 3) = -1.0;
  start.direction.modes = direction.modes;
  const loop::Loop small = loop::moved(start.base, start.direction, 1e-3);
  for (const loop::SymmetryElement& element : loop::find_isotropy(system->structure(), small, 1e-9))
    if (element.name == "S" || element.name == "R")
      if (element.shift_numerator == 0) start.isotropy.push_back(element);
  std::vector<loop::Loop> loops;
  continuation::Options options;
  options.energy_to = 0.15;
  for (const continuation::Orbit& orbit : test::orbits_of(system, start, options))
    if (orbit.energy > 0.01) loops.push_back(orbit.loop);
  return loops;
}

TEST(HenonHeilesIndex, AgreesWithDirectIntegration) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<loop::Loop> loops = henon_orbits(system);
  ASSERT_GE(loops.size(), 3u);
  double spread = 0.0;
  for (const loop::Loop& loop : loops) {
    const loop::Isotropy isotropy = isotropy_of(*system, loop);
    const Stability stability = floquet(*system, loop, isotropy);
    const double truth = henon_index(loop);
    SCOPED_TRACE(testing::Message() << "T = " << loop.period << ", isotropy " << loop::to_text(isotropy));
    ASSERT_EQ(stability.full.size(), 1u);
    EXPECT_NEAR(stability.full[0].real(), truth, 1e-9);
    EXPECT_LE(std::abs(stability.full[0] - truth), stability.full_error[0]);
    EXPECT_LE(stability.full_error[0], 1e-8);
    spread = std::max(spread, std::abs(truth - 2.0));
  }
  EXPECT_GT(spread, 0.1) << "the orbits should not all be nearly parabolic";
}

// --- contract ---

TEST(Floquet, SameInputGivesSameBits) {
  const auto system = systems::make_system("henon_heiles");
  const loop::Loop loop = henon_orbits(system).back();
  const Stability first = floquet(*system, loop, {});
  const Stability second = floquet(*system, loop, {});
  EXPECT_EQ(first.full, second.full);
  EXPECT_EQ(first.full_error, second.full_error);
}

TEST(Floquet, RefusesWhatIsNoOrbit) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> point(4, 0.0);
  EXPECT_THROW((void)floquet(*system, loop::constant_loop(point, 1.0, 3), {}), core::MisuseError);
  EXPECT_THROW((void)floquet(*system, first_oscillation(2), {}), core::MisuseError);
}

}  // namespace
}  // namespace floquet_test
