#include "orbweaver/starts/equilibrium_curve.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/model/model_system.hpp"
#include "support/described.hpp"
#include "support/lorenz_equations.hpp"
#include "support/van_der_pol.hpp"

namespace orbweaver::starts::equilibrium_curve_test {
namespace {

/// With sigma = 10, beta = 8/3: Hopf points at rho = sigma (sigma + beta + 3)/(sigma - beta - 1) = 470/19, with
/// omega^2 = 2 sigma (sigma + 1) beta/(sigma - beta - 1); the two equilibria leave the origin at rho = 1.
constexpr double hopf_rho = 470.0 / 19.0;
const double hopf_period =
    2.0 * std::numbers::pi / std::sqrt(2.0 * 10.0 * 11.0 * (8.0 / 3.0) / (10.0 - 8.0 / 3.0 - 1.0));

TEST(EquilibriumCurve, OfLorenzHasTheKnownHopfPoint) {
  const test::LorenzEquations system(20.0);
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{x, x, 19.0}, {.parameter_from = 1.5, .parameter_to = 30.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_NEAR(curve.hopf[0].at.parameter, hopf_rho, 1e-11);
  EXPECT_NEAR(curve.hopf[0].period, hopf_period, 1e-11);
  EXPECT_TRUE(curve.hopf[0].isotropy.empty());
  EXPECT_THAT(curve.ends, ::testing::ElementsAre(::testing::HasSubstr("rho = 1.5"), ::testing::HasSubstr("rho = 30")));
  EXPECT_NEAR(curve.points.back().at.state[2], 29.0, 1e-10);
}

TEST(EquilibriumCurve, ThroughThePitchforkTurnsOnTheOtherSide) {
  // x = y = +-sqrt(beta (rho - 1)): one curve, whose rho turns at 1 at the origin.
  const test::LorenzEquations system(20.0);
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{x, x, 19.0}, {.parameter_from = 0.0, .parameter_to = 25.0});
  ASSERT_EQ(curve.folds.size(), 1U);
  EXPECT_NEAR(curve.folds[0].parameter, 1.0, 1e-10);
  EXPECT_NEAR(curve.folds[0].state[0], 0.0, 1e-5);
  EXPECT_EQ(curve.hopf.size(), 2U);  // one on each side
}

std::vector<EquilibriumPoint> branch_points(const EquilibriumCurve& curve) {
  std::vector<EquilibriumPoint> found;
  for (const EquilibriumPoint& point : curve.points)
    if (point.kind == EquilibriumKind::branch_point) found.push_back(point);
  return found;
}

TEST(EquilibriumCurve, KnowsWhereTheOtherCurveOfAPitchforkPasses) {
  const auto origin = [](double rho) {  // from 0.5 on a step ends at the branch point itself
    return follow_equilibrium(test::LorenzEquations(rho), std::vector<double>(3, 0.0),
                              {.parameter_from = 0.0, .parameter_to = 25.0});
  };
  const EquilibriumCurve through = origin(0.5);
  const EquilibriumCurve past = origin(0.53);
  EXPECT_TRUE(through.folds.empty());
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve beside = follow_equilibrium(test::LorenzEquations(20.0), std::vector<double>{x, x, 19.0},
                                                     {.parameter_from = 0.0, .parameter_to = 25.0});
  for (const EquilibriumCurve* curve : {&through, &past, &beside}) {
    const std::vector<EquilibriumPoint> found = branch_points(*curve);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].at.parameter, 1.0, 1e-9);
    for (const double z : found[0].at.state) EXPECT_NEAR(z, 0.0, 1e-5);
  }
}

/// x' = m x - x^3 and y' = m y - y^3: two eigenvalues pass zero at once, where the determinant keeps its sign.
class TwoPitchforks {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("two_pitchforks", "two pitchforks at once", {"x", "y"}, {"m"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.dissipative = true;
    return structure;
  }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _m(bound["m"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] * _m - z[0] * z[0] * z[0];
      f[1] = z[1] * _m - z[1] * z[1] * z[1];
    }

   private:
    P _m;
  };
};

TEST(EquilibriumCurve, KnowsABranchPointAtWhichTwoEigenvaluesPassZero) {
  for (const double start : {-0.37, -0.43, -0.5}) {
    systems::Bound bound = systems::bound_to(TwoPitchforks::info(), {{"m", start}}, {});
    bound.scalars.free = {"m"};
    const EquilibriumCurve curve =
        follow_equilibrium(*systems::Registered<TwoPitchforks>::make(bound), std::vector<double>(2, 0.0),
                           {.parameter_from = -1.0, .parameter_to = 1.0});
    const std::vector<EquilibriumPoint> found = branch_points(curve);
    ASSERT_EQ(found.size(), 1U) << start;
    EXPECT_NEAR(found[0].at.parameter, 0.0, 1e-12);
  }
}

TEST(EquilibriumCurve, OfVanDerPolHasItsHopfPointAtZero) {
  const test::VanDerPol system(-0.5, {{"mu"}, {}});
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{0.0, 0.0}, {.parameter_from = -1.0, .parameter_to = 1.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_TRUE(branch_points(curve).empty());
  EXPECT_NEAR(curve.hopf[0].at.parameter, 0.0, 1e-12);
  EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi, 1e-12);
}

/// Two oscillators with eigenvalues m - m_n +- i w_n, the second of which pushes the first.
class TwoOscillators {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("two_oscillators", "two oscillators, the first pushed by the second", {"x", "u", "y", "v"},
                           {"m", "m1", "m2", "w1", "w2"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.dissipative = true;
    return structure;
  }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _m(bound["m"]), _m1(bound["m1"]), _m2(bound["m2"]), _w1(bound["w1"]), _w2(bound["w2"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] * (_m - _m1) - z[1] * _w1 + z[2] * z[2];
      f[1] = z[0] * _w1 + z[1] * (_m - _m1) + z[2] * 0.1;
      f[2] = z[2] * (_m - _m2) - z[3] * _w2;
      f[3] = z[2] * _w2 + z[3] * (_m - _m2) - z[3] * z[3] * z[3];
    }

   private:
    P _m, _m1, _m2, _w1, _w2;
  };
};

// Both within one step of the curve, or at one place: two changes of the product of all sums of eigenvalues cancel.
TEST(EquilibriumCurve, TwoHopfPointsWithinOneStepAreFound) {
  for (const double start : {-0.37, -0.43, -0.5, -0.05})
    for (const auto& [m1, m2] : {std::pair(3.5e-5, 0.04997), std::pair(0.0, 0.0), std::pair(0.01, 0.01 + 1e-7)}) {
      SCOPED_TRACE(fmt::format("{} {}", start, m2));
      systems::Bound bound = systems::bound_to(TwoOscillators::info(),
                                               {{"m", start}, {"m1", m1}, {"m2", m2}, {"w1", 1.0}, {"w2", 1.7}}, {});
      bound.scalars.free = {"m"};
      const auto system = systems::Registered<TwoOscillators>::make(bound);
      const EquilibriumCurve curve =
          follow_equilibrium(*system, std::vector<double>(4, 0.0), {.parameter_from = -1.0, .parameter_to = 1.0});
      ASSERT_EQ(curve.hopf.size(), 2U);
      EXPECT_NEAR(curve.hopf[0].at.parameter, m1, 1e-12);
      EXPECT_NEAR(curve.hopf[1].at.parameter, m2, 1e-12);
      EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi, 1e-11);
      EXPECT_NEAR(curve.hopf[1].period, 2.0 * std::numbers::pi / 1.7, 1e-11);
    }
}

TEST(EquilibriumCurve, NeedsAParameterThatMovesAndAnEquilibrium) {
  EXPECT_THROW(static_cast<void>(follow_equilibrium(test::VanDerPol(0.5), std::vector<double>{0.0, 0.0})),
               core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::equilibrium_curve_test
