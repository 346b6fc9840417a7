#include "orbweaver/starts/linear_modes.hpp"

#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/quad.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::starts::linear_modes_test {
namespace {

using numerics::Quad;
using testing::HasSubstr;
constexpr double pi = std::numbers::pi;

using Parameters = std::map<std::string, double>;

/// Squares of the angular frequencies about an equilibrium with the rods up (-1) or down (1), the larger first: roots
/// of det(K - w^2 M) = 0 from the Lagrangian, in quadruple precision; the smaller from the product of both. Negative
/// ones are unstable.
std::pair<Quad, Quad> squares(const Parameters& p, int up_1, int up_2) {
  const auto at = [&](const char* name) { return Quad(p.at(name)); };
  const Quad mass = at("m1") + at("m2");
  // w^4 det M - w^2 b + det K = 0, divided by m2 l1 l2.
  const Quad a = at("m1") * at("l1") * at("l2");
  const Quad b = mass * at("g") * (up_1 * at("l2") + up_2 * at("l1"));
  const Quad c = mass * at("g") * at("g") * (up_1 * up_2);
  const Quad root = sqrt(b * b - 4 * a * c);
  const Quad larger = b < 0 ? Quad((b - root) / (2 * a)) : Quad((b + root) / (2 * a));
  const Quad other = c / (a * larger);
  return larger > other ? std::pair(larger, other) : std::pair(other, larger);
}

std::vector<double> periods(const Parameters& p, int up_1, int up_2) {
  const auto [larger, smaller] = squares(p, up_1, up_2);
  std::vector<double> out;
  for (const Quad& square : {smaller, larger})
    if (square > 0) out.push_back((2 * boost::math::constants::pi<Quad>() / sqrt(square)).convert_to<double>());
  return out;
}

std::vector<double> point_of(int up_1, int up_2) { return {up_1 > 0 ? 0.0 : pi, up_2 > 0 ? 0.0 : pi, 0.0, 0.0}; }

// Every ratio of masses and of lengths from 1e-6 to 1e6, each alone and together, in units that are no powers of two.
TEST(LinearModes, AllPeriodsOfPendulumsOfAnyProportions) {
  double worst = 0.0;
  for (int mass = -6; mass <= 6; mass += 1)
    for (int length = -6; length <= 6; length += 1)
      for (const double unit : {1.0, 0.3, 1e-6}) {
        const Parameters p{{"m1", unit},
                           {"m2", unit * std::pow(10.0, mass)},
                           {"l1", 0.7 * unit},
                           {"l2", 0.7 * unit * std::pow(10.0, length)},
                           {"g", 9.81}};
        const auto system = systems::make_system("double_pendulum", p);
        for (const int up_1 : {1, -1})
          for (const int up_2 : {1, -1}) {
            const LinearModes modes = linear_modes(*system, point_of(up_1, up_2));
            const std::vector<double> wanted = periods(p, up_1, up_2);
            ASSERT_EQ(modes.oscillations.size(), wanted.size()) << mass << " " << length << " " << up_1 << up_2;
            EXPECT_TRUE(modes.undecided.empty()) << mass << " " << length << " " << up_1 << up_2;
            for (std::size_t n = 0; n < wanted.size(); ++n) {
              EXPECT_EQ(modes.oscillations[n].multiplicity(), 1);
              worst = std::max(worst, std::abs(modes.oscillations[n].period / wanted[n] - 1.0));
            }
            EXPECT_EQ(modes.rest.size(), 4 - 2 * wanted.size());
            EXPECT_EQ(modes.stability, wanted.size() == 2 ? LinearStability::elliptic : LinearStability::unstable);
          }
      }
  RecordProperty("worst_relative_error", fmt::format("{:.3e}", worst));
  EXPECT_LT(worst, 1e-12);
}

TEST(LinearModes, KernelVectorsSolveTheLinearProblem) {
  for (const double ratio : {1.0, 1e-3, 1e3}) {
    const auto system = systems::make_system("double_pendulum", {{"m2", ratio}, {"l2", ratio}});
    const std::vector<double> origin(4, 0.0);
    Eigen::Vector4d f;
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> a;
    system->field_jacobian(1, origin.data(), f.data(), a.data());
    for (const Oscillation& oscillation : linear_modes(*system, origin).oscillations) {
      const Eigen::VectorXcd v = oscillation.kernel.col(0);
      EXPECT_NEAR(v.norm(), 1.0, 1e-14);
      const std::complex<double> rate(0.0, 2.0 * pi / oscillation.period);
      EXPECT_LT((rate * v - a * v).norm(), 1e-14 * a.norm());
      EXPECT_LT(oscillation.residual, 1e-14 * a.norm());
    }
  }
}

TEST(LinearModes, InMilliseconds) {
  const auto system = systems::make_system("double_pendulum", {{"m2", 1e6}});
  const std::clock_t began = std::clock();  // of the processor, whatever else runs
  constexpr int times = 20;
  for (int n = 0; n < times; ++n) EXPECT_EQ(linear_modes(*system, std::vector<double>(4, 0.0)).oscillations.size(), 2u);
  const double each = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / times;
  RecordProperty("seconds", fmt::format("{:.3e}", each));
  EXPECT_LT(each, 0.05) << "a millisecond without sanitizers";
}

/// Zeros of Laguerre's polynomial of degree n, ascending: eigenvalues of its recurrence (Golub and Welsch 1969).
Eigen::VectorXd zeros_of_laguerre(int n) {
  using Real = long double;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> recurrence = decltype(recurrence)::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    recurrence(k, k) = 2 * k + 1;
    if (k > 0) recurrence(k, k - 1) = recurrence(k - 1, k) = k;
  }
  return Eigen::SelfAdjointEigenSolver<decltype(recurrence)>(recurrence).eigenvalues().cast<double>();
}

TEST(LinearModes, OfSixtyFourCoordinatesInSeconds) {
  constexpr int links = 32;
  const auto system = systems::make_system("pendulum_chain", {{"links", links}});
  const std::clock_t began = std::clock();
  const LinearModes modes = linear_modes(*system, std::vector<double>(2 * links, 0.0));
  const double seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  RecordProperty("seconds", fmt::format("{:.2f}", seconds));
  EXPECT_LT(seconds, 6.0) << "0.4 where nothing else runs; 13 with a kernel for each mode";
  const Eigen::VectorXd zeros = zeros_of_laguerre(links);
  ASSERT_EQ(modes.oscillations.size(), static_cast<std::size_t>(links));
  for (int n = 0; n < links; ++n) {
    const Oscillation& mode = modes.oscillations[static_cast<std::size_t>(n)];
    const double period = 2.0 * pi / std::sqrt(zeros(n));
    EXPECT_NEAR(mode.period, period, 1e-12 * period) << n;
    EXPECT_EQ(mode.kernel.cols(), 1) << n;
    EXPECT_LT(mode.residual, 1e-12 * zeros(links - 1)) << n;
  }
}

/// dz/dt = A z.
class LinearField final : public test::PointSystem {
 public:
  LinearField(systems::Structure structure, Eigen::MatrixXd a) : PointSystem(std::move(structure)), _a(std::move(a)) {}
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override { return _a * z; }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd&) const override { return _a; }

 private:
  Eigen::MatrixXd _a;
};

/// q'' = -K q, state q, q'.
LinearModes of_stiffness(const Eigen::MatrixXd& stiffness) {
  const Eigen::Index n = stiffness.rows();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -stiffness;
  const LinearField system(test::structure_of(static_cast<int>(2 * n), true, true), a);
  return linear_modes(system, std::vector<double>(static_cast<std::size_t>(2 * n), 0.0));
}

LinearModes of_matrix(const Eigen::MatrixXd& a, bool symplectic) {
  const LinearField system(test::structure_of(static_cast<int>(a.rows()), symplectic, symplectic), a);
  return linear_modes(system, std::vector<double>(static_cast<std::size_t>(a.rows()), 0.0));
}

TEST(LinearModes, EqualFrequenciesShareAKernel) {
  // Turned by an angle, so that the entries are rounded: 1, 1 and 4.
  Eigen::Matrix3d turn;
  turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const LinearModes modes = of_stiffness(turn * Eigen::Vector3d(1, 1, 4).asDiagonal() * turn.transpose());
  ASSERT_EQ(modes.oscillations.size(), 2u);
  EXPECT_EQ(modes.oscillations[0].multiplicity(), 2);
  EXPECT_EQ(modes.oscillations[1].multiplicity(), 1);
  EXPECT_NEAR(modes.oscillations[0].period, 2 * pi, 1e-14);
  EXPECT_NEAR(modes.oscillations[1].period, pi, 1e-14);
  EXPECT_EQ(modes.stability, LinearStability::elliptic);
  EXPECT_TRUE(modes.undecided.empty());
  ASSERT_EQ(modes.resonances.size(), 1u);
  EXPECT_EQ(modes.resonances[0].slow, 0u);
  EXPECT_EQ(modes.resonances[0].fast, 1u);
  EXPECT_EQ(modes.resonances[0].ratio, 2);
}

TEST(LinearModes, NearlyEqualFrequenciesThatRoundingTellsApart) {
  for (const double gap : {1e-3, 1e-9, 1e-12}) {
    const LinearModes modes = of_stiffness(Eigen::Vector2d(1.0, 1.0 + gap).asDiagonal());
    ASSERT_EQ(modes.oscillations.size(), 2u) << gap;
    EXPECT_TRUE(modes.resonances.empty());
    const LinearModes ratio = of_stiffness(Eigen::Vector2d(1.0, 9.0 * (1.0 + gap)).asDiagonal());
    EXPECT_TRUE(ratio.resonances.empty()) << gap;
  }
  EXPECT_EQ(of_stiffness(Eigen::Vector2d(1.0, 9.0).asDiagonal()).resonances.size(), 1u);
}

/// H = (1 + d) (q1^2 + p1^2)/2 - (1 - d) (q2^2 + p2^2)/2 + c (q1 q2 - p1 p2), state q1, q2, p1, p2: oscillations of
/// opposite signature with frequencies 1 +- sqrt(d^2 - c^2), which collide at c = d and leave the imaginary axis.
Eigen::MatrixXd krein(double detuning, double coupling) {
  Eigen::Matrix4d hessian = Eigen::Vector4d(1 + detuning, -(1 - detuning), 1 + detuning, -(1 - detuning)).asDiagonal();
  hessian(0, 1) = hessian(1, 0) = coupling;
  hessian(2, 3) = hessian(3, 2) = -coupling;
  Eigen::Matrix4d j = Eigen::Matrix4d::Zero();
  j.topRightCorner<2, 2>().setIdentity();
  j.bottomLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity();
  return j * hessian;
}

TEST(LinearModes, ACollisionIsSaidAndNotGuessed) {
  const auto frequencies = [](const LinearModes& modes) {
    std::vector<double> out;
    for (const Oscillation& o : modes.oscillations) out.push_back(2 * pi / o.period);
    return out;
  };
  const LinearModes before = of_matrix(krein(0.25, 0.15), true);
  ASSERT_EQ(before.oscillations.size(), 2u);
  EXPECT_EQ(before.stability, LinearStability::elliptic);
  EXPECT_NEAR(frequencies(before)[0] + frequencies(before)[1], 2.0, 1e-14);
  const LinearModes after = of_matrix(krein(0.15, 0.25), true);
  EXPECT_TRUE(after.oscillations.empty());
  EXPECT_TRUE(after.undecided.empty());
  EXPECT_EQ(after.stability, LinearStability::unstable);
  EXPECT_EQ(after.rest.size(), 4u);
  // At the collision, and beside it: apart by some 1e-8, which rounding of the entries moves by as much.
  for (const int roundings : {-4, -1, 0, 1, 4}) {
    const LinearModes at =
        of_matrix(krein(0.25, 0.25 * (1.0 + roundings * std::numeric_limits<double>::epsilon())), true);
    EXPECT_TRUE(at.oscillations.empty()) << roundings;
    EXPECT_TRUE(at.rest.empty()) << roundings;
    EXPECT_EQ(at.stability, LinearStability::undecided);
    ASSERT_EQ(at.undecided.size(), 1u);
    EXPECT_EQ(at.undecided[0].doubt, roundings == 0 ? Doubt::defective : Doubt::unresolved);
    EXPECT_EQ(at.undecided[0].count, 2);
    EXPECT_NEAR(at.undecided[0].period(), 2 * pi, 1e-6);
    EXPECT_FALSE(to_text(at.undecided[0]).empty());
  }
}

TEST(LinearModes, WhatIsUndecidedIsAmongTheRejected) {
  const LinearField system(test::structure_of(4, true, true), krein(0.25, 0.25));
  const SweepResult result = sweep(system, std::vector<double>(4, 0.0), {.period_from = 5.0, .period_to = 7.0});
  EXPECT_TRUE(result.modes.empty());
  ASSERT_FALSE(result.rejected.empty());
  EXPECT_NEAR(result.rejected.back().period, 2 * pi, 1e-6);
  EXPECT_THAT(result.rejected.back().reason, HasSubstr("2 eigenvalues of the Jacobian are one"));
}

TEST(LinearModes, WithoutAStructureARealPartOfRoundingIsUndecided) {
  Eigen::Matrix2d spiral;
  spiral << 1e-17, 1.0, -1.0, 0.0;
  const LinearModes modes = of_matrix(spiral, false);
  EXPECT_TRUE(modes.oscillations.empty());
  ASSERT_EQ(modes.undecided.size(), 1u);
  EXPECT_EQ(modes.undecided[0].doubt, Doubt::real_part);
  spiral(0, 0) = -0.25;
  const LinearModes stable = of_matrix(spiral, false);
  EXPECT_TRUE(stable.undecided.empty());
  EXPECT_EQ(stable.stability, LinearStability::stable);
  EXPECT_EQ(stable.rest.size(), 2u);
}

TEST(LinearModes, TranslationsAreNeutral) {
  // Two bodies on a spring: a double zero with one vector beside the oscillation.
  Eigen::Matrix2d spring;
  spring << 1, -1, -1, 1;
  const LinearModes modes = of_stiffness(spring);
  ASSERT_EQ(modes.oscillations.size(), 1u);
  EXPECT_NEAR(modes.oscillations[0].period, 2 * pi / std::sqrt(2.0), 1e-14);
  EXPECT_TRUE(modes.undecided.empty());
  EXPECT_EQ(modes.stability, LinearStability::neutral);
  EXPECT_EQ(modes.rest, (std::vector<std::complex<double>>(2, 0.0)));
}

// A coordinate along a curve of equilibria, in whose equation only rounding is left.
TEST(LinearModes, RoundingInAnEquationMovesNoVectors) {
  for (const double rest : {1e-17, 1e-34, 1e-60}) {
    SCOPED_TRACE(rest);
    const LinearModes modes = of_stiffness(Eigen::Vector2d(1.8, rest).asDiagonal());
    ASSERT_FALSE(modes.oscillations.empty());
    EXPECT_NEAR(modes.oscillations.back().period, 2 * pi / std::sqrt(1.8), 1e-14);
    const Eigen::VectorXcd vector = modes.oscillations.back().kernel.col(0);
    EXPECT_LT(std::abs(vector(1)) + std::abs(vector(3)), 1e-14 * vector.norm());
  }
}

TEST(LinearModes, Misuse) {
  const auto system = systems::make_system("double_pendulum");
  EXPECT_THROW(static_cast<void>(linear_modes(*system, std::vector<double>(3, 0.0))), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::linear_modes_test
