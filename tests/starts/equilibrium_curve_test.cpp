#include "orbweaver/starts/equilibrium_curve.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
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

TEST(EquilibriumCurve, OfVanDerPolHasItsHopfPointAtZero) {
  const test::VanDerPol system(-0.5, {{"mu"}, {}});
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{0.0, 0.0}, {.parameter_from = -1.0, .parameter_to = 1.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_NEAR(curve.hopf[0].at.parameter, 0.0, 1e-12);
  EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi, 1e-12);
}

TEST(EquilibriumCurve, NeedsAParameterThatMovesAndAnEquilibrium) {
  EXPECT_THROW(static_cast<void>(follow_equilibrium(test::VanDerPol(0.5), std::vector<double>{0.0, 0.0})),
               core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::equilibrium_curve_test
