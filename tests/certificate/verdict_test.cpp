#include "orbweaver/certificate/verdict.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"

namespace orbweaver::certificate {
namespace {

/// Of an orbit of size 1, some 2 from the origin, along which |dH/dz| is 3 at most.
Certificate certificate(double closure, double drift) {
  return {.closure = closure, .energy_drift = drift, .reach = 2.0, .steepness = 3.0};
}

Verdict verdict(double closure, double drift, double growth, double residual = 1e-12) {
  return judge(certificate(closure, drift), {10.0, residual, 1.0, growth}).verdict;
}

TEST(Verdict, HoldsWithinWhatResidualAndMultipliersExplain) {
  EXPECT_EQ(verdict(1e-11, 1e-11, 2.0), Verdict::holds);
  EXPECT_EQ(verdict(1e-6, 1e-11, 1e5), Verdict::holds);
  EXPECT_EQ(verdict(1e-10, 0.0, 0.5, 0.0), Verdict::holds) << "an exact orbit: the integrator's tolerance is left";
}

TEST(Verdict, SaysNothingWhereTheGrowthAllowsAnything) {
  EXPECT_EQ(verdict(65.0, 1e-11, 1e251), Verdict::says_nothing);
  EXPECT_EQ(verdict(1e-3, 1e-11, 1e8), Verdict::says_nothing);
  EXPECT_EQ(verdict(1e-3, 1e-11, std::numeric_limits<double>::quiet_NaN()), Verdict::says_nothing);
}

TEST(Verdict, ContradictsWhereTheGrowthDoesNotExplainTheClosure) {
  const Judgement found = judge(certificate(1e-3, 1e-11), {10.0, 1e-12, 1.0, 2.0});
  EXPECT_EQ(found.verdict, Verdict::closure_contradicts);
  EXPECT_EQ(found.found, 1e-3);
  EXPECT_LT(found.allowed, 1e-7);
  EXPECT_EQ(found.period, 10.0);
  EXPECT_EQ(verdict(1e-3, 1e-11, 2.0, 1e-6), Verdict::says_nothing) << "its residual explains it";
}

TEST(Verdict, ContradictsWhereTheEnergyChanges) {
  EXPECT_EQ(verdict(1e-11, 1e-6, 1e251), Verdict::drift_contradicts) << "the loop itself: multipliers do not matter";
  EXPECT_EQ(verdict(1e-11, 1e-6, 2.0, 1e-9), Verdict::holds);
  EXPECT_EQ(verdict(1e-11, std::numeric_limits<double>::quiet_NaN(), 2.0), Verdict::holds) << "nothing is conserved";
}

TEST(Verdict, TheCertificateSaysHowFarAndHowSteep) {
  const auto system = systems::make_system("harmonic_oscillator");
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0, 2);
  loop.cosine(1, 0) = 3.0;  // at rest at q = 3 and -3
  const Certificate found = certify(*system, loop);
  std::vector<double> gradient(2);
  system->conserved_gradient(0, std::vector<double>{3.0, 0.0}, gradient);
  EXPECT_DOUBLE_EQ(found.reach, 3.0);
  EXPECT_DOUBLE_EQ(found.steepness, std::abs(gradient[0]));
}

}  // namespace
}  // namespace orbweaver::certificate
