#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"
#include "support/turned_system.hpp"

namespace transverse_turns_test {
namespace {

using namespace orbweaver;
using spectrum::floquet;
using spectrum::Stability;

constexpr double pi = std::numbers::pi;

/// Positions first: q_0, q_1, p_0, p_1, with the frequencies 1 and `frequency`.
std::shared_ptr<const systems::System> oscillators(double frequency) {
  const auto by_pairs = std::make_shared<test::Oscillators>(std::vector<double>{1.0, frequency * frequency});
  return std::make_shared<test::TurnedSystem>(by_pairs, test::exchange({0, 2, 1, 3}));
}

/// q_0 = cos t, p_0 = -sin t.
loop::Loop first_oscillation() {
  loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * pi, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 2) = -1.0;
  return loop;
}

// The other oscillator turns f times a period in a frame that turns once against it.
TEST(TransverseTurns, AreThoseOfTheOtherOscillator) {
  for (const double f : {0.3, 0.7, 1.2, 9.4, 100.3, 1000.7}) {
    const auto system = oscillators(f);
    const loop::Loop loop = first_oscillation();
    EXPECT_NEAR(floquet(*system, loop, {}).turns, f + 1.0, 1e-8) << f;
    const Stability half = floquet(*system, loop, loop::find_isotropy(system->structure(), loop, 1e-9));
    ASSERT_EQ(half.fundamental_order, 2);
    EXPECT_NEAR(half.turns, 0.5 * (f + 1.0), 1e-8) << f;
  }
}

TEST(TransverseTurns, AreWholeOrHalfOffTheUnitCircle) {
  const auto by_pairs = std::make_shared<test::Oscillators>(std::vector<double>{1.0, -0.09});
  const test::TurnedSystem saddle(by_pairs, test::exchange({0, 2, 1, 3}));
  const Stability stability = floquet(saddle, first_oscillation(), {});
  EXPECT_GT(stability.fundamental[0].real(), 2.0);
  EXPECT_EQ(stability.turns, 1.0);
}

TEST(TransverseTurns, AreNotKnownOfTwoPairs) {
  const test::Oscillators three({1.0, 2.0, 3.0});
  loop::Loop loop = loop::constant_loop(std::vector<double>(6, 0.0), 2.0 * pi, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 1) = -1.0;
  EXPECT_TRUE(std::isnan(floquet(three, loop, {}).turns));
}

/// A small oscillation about an equilibrium: of its two the slow or the fast one.
struct Oscillation {
  loop::Loop loop;
  double frequency;
  double other;

  Oscillation(const systems::System& system, const std::vector<double>& point, bool is_slow) {
    Eigen::Vector4d field;
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> jacobian;
    system.field_jacobian(1, point.data(), field.data(), jacobian.data());
    const Eigen::EigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(jacobian)};
    std::map<double, Eigen::Vector4cd> modes;
    for (Eigen::Index n = 0; n < 4; ++n)
      if (solver.eigenvalues()[n].imag() > 0.0)
        modes[solver.eigenvalues()[n].imag()] = solver.eigenvectors().col(n).normalized();
    EXPECT_EQ(modes.size(), 2U);
    const auto& own = is_slow ? *modes.begin() : *modes.rbegin();
    frequency = own.first;
    other = is_slow ? modes.rbegin()->first : modes.begin()->first;
    constexpr double size = 1e-6;  // its square is below what is asked for, rounding divided by it too
    const double scale = size / own.second.head<2>().norm();
    loop = loop::constant_loop(point, 2.0 * pi / frequency, 3);
    for (std::size_t i = 0; i < 4; ++i) {
      loop.cosine(1, static_cast<int>(i)) = scale * own.second[static_cast<Eigen::Index>(i)].real();
      loop.sine(1, static_cast<int>(i)) = -scale * own.second[static_cast<Eigen::Index>(i)].imag();
    }
  }
};

/// What the turns of a small oscillation are more than `sense` times the other one's in its period.
double beyond_linear(const systems::System& system, const std::vector<double>& point, bool is_slow, double sense) {
  const Oscillation of(system, point, is_slow);
  return floquet(system, of.loop, {}).turns - sense * of.other / of.frequency;
}

// One whole number for all parameters, however often the fast motion turns in a period of the slow one.
TEST(TransverseTurns, OfPendulumsAreContinuousInTheirLengths) {
  for (const bool is_slow : {true, false})
    for (const double ratio : {1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 3.0, 1e2, 1e4}) {
      const auto system = systems::make_system("double_pendulum", {{"l2", ratio}});
      EXPECT_NEAR(beyond_linear(*system, {0, 0, 0, 0}, is_slow, 1.0), 1.0, 1e-4) << "l2 = " << ratio;
      const auto light = systems::make_system("double_pendulum", {{"m2", ratio}, {"l2", 0.37}});
      EXPECT_NEAR(beyond_linear(*light, {0, 0, 0, 0}, is_slow, 1.0), 1.0, 1e-4) << "m2 = " << ratio;
    }
}

// At L4 the slow oscillation has a negative energy: about the fast one it turns the other way. No reversor, and forces
// that depend on velocities.
TEST(TransverseTurns, AtATriangularPointAreContinuousInTheMass) {
  for (const double mu : {1e-4, 1e-3, 0.00827037, 0.01215, 0.03}) {
    const auto system = systems::make_system("pcr3bp", {{"mu", mu}});
    const std::vector<double> l4{0.5 - mu, 0.5 * std::sqrt(3.0), 0.0, 0.0};
    EXPECT_NEAR(beyond_linear(*system, l4, false, -1.0), 1.0, 1e-4) << mu;
    EXPECT_NEAR(beyond_linear(*system, l4, true, 1.0), -1.0, 1e-4) << mu;
  }
}

TEST(TransverseTurns, OfASpringAreContinuousInItsStiffness) {
  for (const double stiffness : {1.5, 2.9, 3.1, 40.0, 4e3}) {
    const auto system = systems::make_system("swinging_spring", {{"stiffness", stiffness}});
    const std::vector<double> rest{0.0, -1.0 - 1.0 / stiffness, 0.0, 0.0};
    EXPECT_NEAR(beyond_linear(*system, rest, true, 1.0), 1.0, 1e-4) << stiffness;
  }
}

// Units and the order of the positions do not count.
TEST(TransverseTurns, AreTheSameInOtherUnits) {
  const auto system = systems::make_system("double_pendulum", {{"l2", 1e-2}});
  const Oscillation slow(*system, {0, 0, 0, 0}, true);
  const double turns = floquet(*system, slow.loop, {}).turns;
  for (const double unit : {1e-3, 1e3}) {
    Eigen::MatrixXd units = Eigen::MatrixXd::Identity(4, 4);
    units.bottomRightCorner(2, 2) *= unit;
    for (const std::vector<int>& order : {std::vector<int>{0, 1, 2, 3}, std::vector<int>{1, 0, 3, 2}}) {
      const Eigen::MatrixXd turn = test::exchange(order) * units;
      const test::TurnedSystem other(system, turn);
      loop::Loop loop = slow.loop;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>> modes(
          loop.modes.data(), static_cast<Eigen::Index>(loop.modes.size() / 4), 4);
      modes = (modes * turn.transpose()).eval();
      EXPECT_NEAR(floquet(other, loop, {}).turns, turns, 1e-5) << unit;
    }
  }
}

}  // namespace
}  // namespace transverse_turns_test
