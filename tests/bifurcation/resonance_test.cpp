// Families at equilibria whose frequencies are in ratio, against normal forms and shooting.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bifurcation/crossings.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::bifurcation::resonance_test {
namespace {

constexpr double pi = std::numbers::pi;

/// H = (q1^2 + p1^2)/2 + sign (1 + detuning) (q2^2 + p2^2) + q1^2 q2, state q1, q2, p1, p2. With q1 = a cos t and
/// q2 = b cos 2t the mean of the cubic term is a^2 b/4. At sign 1, without detuning, its extrema at fixed a^2/2 + b^2
/// lie at b = +-a/2, where the frequency is 1 + b/2; at sign -1 there are none but a = 0. On the fast family a grows
/// from 0 where b/2 = detuning.
class TwoToOne final : public test::PointSystem {
 public:
  explicit TwoToOne(double sign, double detuning = 0.0)
      : PointSystem(described()), _second(2.0 * sign * (1.0 + detuning)) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::VectorXd g = gradient_at(z);
    return Eigen::Vector4d(g(2), g(3), -g(0), -g(1));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 2) = 1.0;
    a(1, 3) = _second;
    a.bottomLeftCorner<2, 2>() << -1.0 - 2.0 * z(1), -2.0 * z(0), -2.0 * z(0), -_second;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector4d(z(0) + 2.0 * z(0) * z(1), _second * z(1) + z(0) * z(0), z(2), _second * z(3));
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return (z[0] * z[0] + z[2] * z[2] + _second * (z[1] * z[1] + z[3] * z[3])) / 2.0 + z[0] * z[0] * z[1];
  }

 private:
  static systems::Structure described() {
    systems::Structure d = test::structure_of(4, true, true);
    d.reversors = {{"R", Eigen::Matrix4d(Eigen::Vector4d(1, 1, -1, -1).asDiagonal())}};
    return d;
  }

  double _second;
};

/// Three equal particles on a ring, each pulled by exp of its distance from the next (Toda), in the plane across their
/// centre: integrable. To fourth order the energy is I1 + I2 + c (I1^2 + I2^2) in the actions of the two waves around
/// the ring: each alone is a family, and those with I1 = I2 have one period at all phases.
class TodaRing final : public test::PointSystem {
 public:
  TodaRing() : PointSystem(described()) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::VectorXd g = gradient_at(z);
    return Eigen::Vector4d(g(2), g(3), -g(0), -g(1));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a.topRightCorner<2, 2>().setIdentity();
    for (const Eigen::Vector2d& k : pulls()) a.bottomLeftCorner<2, 2>() -= k * k.transpose() * pull(k, z) / 24.0;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    Eigen::Vector4d g(0.0, 0.0, z(2), z(3));
    for (const Eigen::Vector2d& k : pulls()) g.head<2>() += k * pull(k, z) / 24.0;
    return g;
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    double energy = (z[2] * z[2] + z[3] * z[3]) / 2.0;
    for (const Eigen::Vector2d& k : pulls()) energy += std::exp(k(0) * z[0] + k(1) * z[1]) / 24.0;
    return energy;
  }

 private:
  static systems::Structure described() {
    systems::Structure d = test::structure_of(4, true, true);
    d.reversors = {{"R", Eigen::Matrix4d(Eigen::Vector4d(1, 1, -1, -1).asDiagonal())}};
    return d;
  }
  static std::array<Eigen::Vector2d, 3> pulls() {
    const double side = 2.0 * std::sqrt(3.0);
    return {Eigen::Vector2d(side, 2.0), Eigen::Vector2d(-side, 2.0), Eigen::Vector2d(0.0, -4.0)};
  }
  static double pull(const Eigen::Vector2d& k, const Eigen::VectorXd& z) { return std::exp(k.dot(z.head<2>())); }
};

/// Two equal linear oscillators, all of whose motions have one period, and a pendulum that swings faster.
class LinearPairAndPendulum final : public test::PointSystem {
 public:
  LinearPairAndPendulum() : PointSystem(test::structure_of(6, true, true)) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    Eigen::VectorXd f(6);
    f << z.tail<3>(), -gradient_at(z).head<3>();
    return f;
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6, 6);
    a.topRightCorner<3, 3>().setIdentity();
    a.bottomLeftCorner<3, 3>() = -Eigen::Vector3d(1.0, 1.0, 2.0 * std::cos(z(2))).asDiagonal().toDenseMatrix();
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    Eigen::VectorXd g = z;
    g(2) = 2.0 * std::sin(z(2));
    return g;
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return (z[0] * z[0] + z[1] * z[1] + z[3] * z[3] + z[4] * z[4] + z[5] * z[5]) / 2.0 - 2.0 * std::cos(z[2]);
  }
};

SmallOscillations oscillations_of(const systems::System& system, const std::vector<double>& point,
                                  double amplitude = starts::SweepOptions{}.amplitude) {
  starts::SweepOptions options = starts::automatic_range(starts::linear_modes(system, point));
  options.amplitude = amplitude;
  return small_oscillations(system, starts::sweep(system, point, options), 10);
}
SmallOscillations oscillations_of(const systems::System& system) {
  return oscillations_of(system, std::vector<double>(4, 0.0));
}

/// The families of the longest period.
std::vector<SmallOscillation> slow_families(const SmallOscillations& all) {
  std::vector<SmallOscillation> out;
  for (const SmallOscillation& family : all.families)
    if (family.mode.period > 0.75 * all.families.front().mode.period) out.push_back(family);
  return out;
}

double cosine(const loop::Tangent& tangent, int harmonic, int coordinate) {
  return tangent.modes[static_cast<std::size_t>((2 * harmonic - 1) * 4 + coordinate)];
}

TEST(Resonance, AFamilyBesideAContinuumIsFound) {
  const SmallOscillations all = oscillations_of(TodaRing());
  ASSERT_EQ(all.families.size(), 1U) << "and its image, which runs the other way";
  const loop::Tangent& direction = all.families.front().mode.direction;
  const Eigen::Vector2d x(cosine(direction, 1, 0), direction.modes[8]);
  const Eigen::Vector2d y(cosine(direction, 1, 1), direction.modes[9]);
  EXPECT_NEAR(x.norm() / y.norm(), 1.0, 1e-3) << "a circle";
  EXPECT_NEAR(x.dot(y) / x.squaredNorm(), 0.0, 1e-3);
  EXPECT_LT(direction.period(), 0.0);
  ASSERT_EQ(all.kernels.size(), 1U);
  EXPECT_GT(all.kernels.front().not_isolated, 0);
  ASSERT_EQ(all.kernels.front().families.size(), 1U);
  EXPECT_EQ(all.kernels.front().families.front().images, 2);
}

TEST(Resonance, AContinuumLeavesTheOtherFamiliesOfItsEquilibrium) {
  const SmallOscillations all = oscillations_of(LinearPairAndPendulum(), std::vector<double>(6, 0.0));
  ASSERT_EQ(all.families.size(), 1U);
  EXPECT_NEAR(all.families.front().mode.period, std::sqrt(2.0) * pi, 1e-12);
  ASSERT_EQ(all.without_family.size(), 1U);
  EXPECT_NEAR(all.without_family.front().period, 2.0 * pi, 1e-12);
  ASSERT_EQ(all.kernels.size(), 1U);
  EXPECT_GT(all.kernels.front().not_isolated, 0);
}

TEST(Resonance, TwoFamiliesOfOneToTwoLeaveAsTheNormalFormSays) {
  const SmallOscillations all = oscillations_of(TwoToOne(1.0));
  const std::vector<SmallOscillation> slow = slow_families(all);
  ASSERT_EQ(slow.size(), 2U);
  EXPECT_EQ(all.count, 3);
  EXPECT_EQ(all.families.back().place, 2);
  EXPECT_NEAR(all.families.back().mode.period, pi, 1e-12);
  // The longer period first: b < 0.
  for (const double sign : {-1.0, 1.0}) {
    const SmallOscillation& family = slow[sign < 0.0 ? 0 : 1];
    EXPECT_EQ(family.place, sign < 0.0 ? 0 : 1);
    EXPECT_FALSE(family.both_sides);
    EXPECT_EQ(loop::to_text(family.mode.isotropy), "R@0");
    const loop::Tangent& direction = family.mode.direction;
    const double a = cosine(direction, 1, 0);
    const double b = cosine(direction, 2, 1);
    const double size = family.amplitude;
    EXPECT_NEAR(b / a, 0.5 * sign, 3.0 * size);
    EXPECT_NEAR(direction.period() / (2.0 * pi), -0.5 * b, 3.0 * size * std::abs(b));
  }
  ASSERT_EQ(all.kernels.size(), 1U);
  const OscillationKernel& kernel = all.kernels.front();
  EXPECT_EQ(kernel.dimension, 2);
  EXPECT_TRUE(kernel.is_definite);
  ASSERT_EQ(kernel.families.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(kernel.families[n].place, static_cast<int>(n));
    EXPECT_EQ(kernel.families[n].images, 1);
    EXPECT_EQ(kernel.families[n].repetitions, n < 2 ? 1 : 2);
  }
}

/// The same, or another point system, with its first two coordinates turned by 45 degrees, and so their momenta.
class Turned final : public test::PointSystem {
 public:
  explicit Turned(const test::PointSystem& system) : PointSystem(system.structure()), _system(system) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.25 * pi).toRotationMatrix();
    _turn.topLeftCorner<2, 2>() = _turn.bottomRightCorner<2, 2>() = turn;
  }

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return _turn.transpose() * _system.field_at(_turn * z);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    return _turn.transpose() * _system.jacobian_at(_turn * z) * _turn;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return _turn.transpose() * _system.gradient_at(_turn * z);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    const Eigen::Vector4d turned = _turn * Eigen::Map<const Eigen::Vector4d>(z.data());
    return _system.conserved(k, {turned.data(), 4});
  }

 private:
  const test::PointSystem& _system;
  Eigen::Matrix4d _turn = Eigen::Matrix4d::Zero();
};

// The first coordinate, (a cos s + b cos 2s)/sqrt 2, is largest off the reversor's fixed set on one of the families.
TEST(Resonance, FamiliesStartOnTheFixedSetOfTheirReversor) {
  const TwoToOne plain(1.0);
  const std::vector<SmallOscillation> slow = slow_families(oscillations_of(Turned(plain)));
  ASSERT_EQ(slow.size(), 2U);
  for (const SmallOscillation& family : slow) {
    EXPECT_EQ(loop::to_text(family.mode.isotropy), "R@0");
    const loop::Loop base = loop::constant_loop(std::vector<double>(4, 0.0), family.mode.period, 10);
    const std::vector<double> start =
        loop::state_at(loop::perturbation(base, loop::with_cutoff(family.mode.direction, 10, 4)), 0.0);
    EXPECT_LT(std::hypot(start[2], start[3]), 1e-6);
  }
}

TEST(Resonance, NoneLeavesWhereTheEnergiesHaveOppositeSigns) {
  const SmallOscillations all = oscillations_of(TwoToOne(-1.0));
  ASSERT_EQ(all.families.size(), 1U);
  EXPECT_NEAR(all.families[0].mode.period, pi, 1e-12);
  EXPECT_EQ(all.families[0].place, 1);
  EXPECT_EQ(all.count, 2);
  ASSERT_EQ(all.without_family.size(), 1U);
  EXPECT_EQ(all.without_family[0].reason,
            "a resonance (2 times T = 3.14159265359): no family leaves along this oscillation");
  EXPECT_FALSE(all.kernels.at(0).is_definite);
}

// Of the fast family (length of its direction in the kernel: b sqrt 2) the other is born at b = 2 |detuning|. Once that
// is further out than the first orbits it is left to the crossing there.
TEST(Resonance, NearlyIsAsExactlyUpToTheAmplitudeOfFirstOrbits) {
  const double amplitude = 0.01;
  const double born_there = amplitude / (2.0 * std::numbers::sqrt2);
  const std::vector<double> origin(4, 0.0);
  const SmallOscillations exact = oscillations_of(TwoToOne(1.0), origin, amplitude);
  for (const double detuning : {1e-9, -1e-9, 1e-6, -1e-6}) {
    const std::vector<SmallOscillation> slow =
        slow_families(oscillations_of(TwoToOne(1.0, detuning), origin, amplitude));
    ASSERT_EQ(slow.size(), 2U) << detuning;
    for (std::size_t n = 0; n < 2; ++n)
      for (const auto& [harmonic, coordinate] : {std::pair{1, 0}, std::pair{2, 1}})
        EXPECT_NEAR(cosine(slow[n].mode.direction, harmonic, coordinate),
                    cosine(exact.families[n].mode.direction, harmonic, coordinate), 200.0 * std::abs(detuning) + 1e-6);
  }
  for (const double share : {0.3, 0.6, 0.8, 0.9, 0.95, 1.05, 1.1, 1.3, 1.6, 1.9, 2.2, 10.0})
    for (const double sign : {1.0, -1.0})
      EXPECT_EQ(slow_families(oscillations_of(TwoToOne(1.0, sign * share * born_there), origin, amplitude)).size(),
                share < 1.0 ? 2U : 1U)
          << sign * share;
}

// Oscillations of nearly one period, too: along an axis each, and the two circles if they are one.
TEST(Resonance, HenonHeilesHasEightFamiliesWithImages) {
  const auto system = systems::make_system("henon_heiles");
  const SmallOscillations all = oscillations_of(*system);
  ASSERT_EQ(all.kernels.size(), 1U);
  std::vector<int> images;
  for (const KernelFamily& family : all.kernels[0].families) images.push_back(family.images);
  EXPECT_EQ(images, (std::vector<int>{3, 3, 2}));
  EXPECT_TRUE(all.kernels[0].is_definite);
  EXPECT_EQ(all.kernels[0].not_isolated, 0);
  for (const SmallOscillation& family : all.families) EXPECT_EQ(family.amplitude, 0.0);
}

/// Shooting near an equilibrium: orbits that leave the fixed set of a reversor (its positions with velocities 0, or
/// positions 0 with velocities) come back to it after half a period.
class Shooting {
 public:
  Shooting(const systems::System& system, std::vector<double> point, bool from_rest)
      : _system(system), _point(std::move(point)), _from_rest(from_rest) {
    const starts::LinearModes modes = starts::linear_modes(system, _point);
    _period = modes.oscillations.at(0).period;
    for (int n = 0; n < 2; ++n) {
      Eigen::VectorXcd v = modes.oscillations.at(static_cast<std::size_t>(n)).kernel.col(0);
      v *= std::conj(v(largest(v))) / std::abs(v(largest(v)));
      _positions.col(n) = v.head<2>().real().normalized();
    }
  }

  /// Families of orbits that start from amplitude r cos(angle) of the slow and r sin(angle) of the fast oscillation,
  /// angle in (-pi/2, pi/2): sign changes of what is left of the fast one where the slow one is back.
  [[nodiscard]] std::vector<double> families(double r) const {
    constexpr int samples = 40;
    std::vector<double> found;
    double before = 0.0;
    for (int n = 0; n <= samples; ++n) {
      const double angle = 0.5 * pi * (2.0 * (n + 0.5) / (samples + 1.0) - 1.0) * 0.97;
      const double here = left_over(r, angle);
      if (n > 0 && here * before < 0.0) found.push_back(angle);
      before = here;
    }
    return found;
  }

 private:
  static Eigen::Index largest(const Eigen::VectorXcd& v) { return std::abs(v(0)) > std::abs(v(1)) ? 0 : 1; }

  /// Coordinates along the two oscillations of what the reversor's fixed set has 0.
  [[nodiscard]] Eigen::Vector2d away(const Eigen::Vector2d& start, double time) const {
    std::vector<double> z = _point;
    for (std::size_t i = 0; i < 2; ++i) z[_from_rest ? i : i + 2] += start(static_cast<Eigen::Index>(i));
    z = certificate::integrate(_system, z, time, 1e-13);
    Eigen::Vector2d moved;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t at = _from_rest ? i + 2 : i;
      moved(static_cast<Eigen::Index>(i)) = z[at] - _point[at];
    }
    return _positions.inverse() * moved;
  }

  [[nodiscard]] double left_over(double r, double angle) const {
    const Eigen::Vector2d start = _positions * Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
    const auto slow = [&](double time) { return away(start, time)(0); };
    double low = 0.48 * _period;
    double high = 0.52 * _period;
    const double at_low = slow(low);
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (low + high);
      (slow(middle) * at_low > 0.0 ? low : high) = middle;
    }
    return away(start, low)(1);
  }

  const systems::System& _system;
  std::vector<double> _point;
  bool _from_rest;
  double _period = 0.0;
  Eigen::Matrix2d _positions;
};

TEST(Resonance, AsManySwingingFamiliesOfTheSpringAsByShooting) {
  const auto system = systems::make_system("swinging_spring");
  const std::vector<double> rest{0.0, -4.0 / 3.0, 0.0, 0.0};
  const std::vector<SmallOscillation> slow = slow_families(oscillations_of(*system, rest));
  EXPECT_EQ(Shooting(*system, rest, true).families(0.01).size(), 2U);
  ASSERT_EQ(slow.size(), 2U);
  for (const SmallOscillation& family : slow) EXPECT_EQ(loop::to_text(family.mode.isotropy), "S@1/2 R@0");
}

// Lengths and first mass 1: the squares of the frequencies have the sum 2 (1 + m2) and the product 1 + m2, so that the
// ratio is n where (1 + m2) 4 = (1 + n^2)^2/n^2.
TEST(Resonance, FamiliesOfTheDoublePendulumByShooting) {
  for (const double n : {2.0, 3.0}) {
    const double ratio = (1.0 + n * n) / n;
    const auto system = systems::make_system("double_pendulum", {{"m2", 0.25 * ratio * ratio - 1.0}});
    const std::vector<double> rest(4, 0.0);
    const std::vector<SmallOscillation> slow = slow_families(oscillations_of(*system, rest));
    // From rest, and through the point of rest. Both have the oscillation that the mirror singles out at 1:2, and of
    // 1:3 the one that is left of it; at 1:2 terms of sixth order leave one more each, twice: a mirror image.
    const std::size_t expected = n < 2.5 ? 3U : 1U;
    EXPECT_EQ(Shooting(*system, rest, true).families(0.2).size(), expected) << n;
    EXPECT_EQ(Shooting(*system, rest, false).families(0.2).size(), expected) << n;
    EXPECT_EQ(slow.size(), n < 2.5 ? 3U : 1U) << n;
  }
}

}  // namespace
}  // namespace orbweaver::bifurcation::resonance_test
