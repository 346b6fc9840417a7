#include "orbweaver/certificate/verdict.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"

namespace orbweaver::certificate::verdict_test {
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
  EXPECT_EQ(verdict(1e-3, 1e-11, 2.0, 1e-6), Verdict::says_nothing) << "its residual explains it";
}

TEST(Verdict, ContradictsWhereTheEnergyChanges) {
  EXPECT_EQ(verdict(1e-11, 1e-6, 1e251), Verdict::drift_contradicts) << "the loop itself: multipliers do not matter";
  EXPECT_EQ(verdict(1e-11, 1e-6, 2.0, 1e-9), Verdict::holds);
  EXPECT_EQ(verdict(1e-11, std::numeric_limits<double>::quiet_NaN(), 2.0), Verdict::holds) << "nothing is conserved";
}

// The first orbit of a family of small oscillations (double pendulum, m2 = 1.7778): its energy of order 1 is rounded.
TEST(Verdict, OfASmallOrbitAllowsForRoundingOfItsEnergy) {
  Certificate small = {.closure = 2e-19, .energy_drift = 5e-16, .reach = 5e-4, .steepness = 5e-4, .energy_size = 4.6};
  const Evidence evidence{2.8, 2e-18, 5e-4, 1.0};
  EXPECT_EQ(judge(small, evidence).verdict, Verdict::holds);
  small.energy_drift = 1e-11;
  EXPECT_EQ(judge(small, evidence).verdict, Verdict::drift_contradicts);
}

// An energy exp(q) - q - 1 + p^2/2 at amplitudes of 1e-5: of its terms of order 1 rounding leaves 1e-16.
TEST(Verdict, AllowsForRoundingOfTermsThatCancel) {
  Certificate cancelling = {
      .closure = 2e-19, .energy_drift = 3e-16, .reach = 1e-5, .steepness = 1e-5, .energy_size = 5e-11};
  const Evidence evidence{6.3, 2e-18, 1e-5, 1.0};
  EXPECT_EQ(judge(cancelling, evidence).verdict, Verdict::drift_contradicts);
  cancelling.energy_rounding = 3.3e-16;
  EXPECT_EQ(judge(cancelling, evidence).verdict, Verdict::holds);
  cancelling.energy_drift = 1e-15;
  EXPECT_EQ(judge(cancelling, evidence).verdict, Verdict::drift_contradicts);
}

// Duffing's equilibrium with the drive at zero, of which only the phase of the drive moves.
TEST(Verdict, OfARestWhilePhasesWindHolds) {
  const Certificate rest{.closure = 9e-16, .recurrence = 1.0, .tail = 2e-18, .reach = 6.3};
  Evidence evidence{5.2, 1e-17, 1e-17, 0.9};
  EXPECT_EQ(judge(rest, evidence).verdict, Verdict::truncated);
  evidence.winds = true;
  EXPECT_EQ(judge(rest, evidence).verdict, Verdict::holds);
}

TEST(Verdict, ReturnsAsFarOffAsADisplacementGrows) {
  Certificate certificate = {.closure = 1e-16, .single_shot = 1e-4, .reach = 1.0, .steepness = 1.0};
  const Evidence evidence{2.0, 1e-14, 1.0, 1.0};
  EXPECT_EQ(judge(certificate, evidence).verdict, Verdict::return_contradicts);
  certificate.displaced_growth = 1e9;
  EXPECT_NE(judge(certificate, evidence).verdict, Verdict::return_contradicts);
}

// An orbit with an index of 2.6e14: once around an integration is anywhere.
TEST(Verdict, ReturnsSayNothingWhereErrorsGrowToTheSizeOfTheOrbit) {
  const Certificate certificate = {.closure = 6e-14, .single_shot = 2.3e6, .reach = 1.7, .steepness = 1.0};
  EXPECT_NE(judge(certificate, {34.8, 2e-15, 1.0, 2.6e14}).verdict, Verdict::return_contradicts);
  EXPECT_EQ(judge(certificate, {34.8, 2e-15, 1.0, 1e6}).verdict, Verdict::return_contradicts);
}

/// Of an orbit that all is well with, at the level `full`.
Certificate whole() {
  Certificate certificate;
  certificate.closure = certificate.taylor_closure = certificate.single_shot = 1e-12;
  certificate.apart = certificate.energy_drift = certificate.symmetry_defect = 1e-13;
  certificate.beside_flow = 1e-12;
  certificate.recurrence = 0.3;
  certificate.tail = 1e-12;
  certificate.reach = 2.0;
  certificate.steepness = 3.0;
  certificate.distance = 1e-11;
  certificate.contraction = 0.1;
  certificate.pairing = 1e-11;
  certificate.index = 2.5;
  return certificate;
}

TEST(Verdict, AllowsTheRoundingOfTheEnergyItself) {
  Certificate small{.closure = 0.0, .energy_drift = 1e-15, .reach = 1e-7, .steepness = 1e-7};
  const Evidence evidence{10.0, 0.0, 1e-7, 2.0};
  EXPECT_EQ(judge(small, evidence).verdict, Verdict::drift_contradicts);
  small.energy_size = 3.0;
  EXPECT_EQ(judge(small, evidence).verdict, Verdict::holds);
  small.energy_drift = 1e-13;
  EXPECT_EQ(judge(small, evidence).verdict, Verdict::drift_contradicts);
}

TEST(Verdict, NamesEachDefect) {
  const Evidence evidence{10.0, 1e-12, 1.0, 2.5, 2.5, 1e-10};
  EXPECT_EQ(judge(whole(), evidence).verdict, Verdict::holds);
  const auto with = [&](double Certificate::*member, double value) {
    Certificate certificate = whole();
    certificate.*member = value;
    return judge(certificate, evidence).verdict;
  };
  EXPECT_EQ(with(&Certificate::other_drift, 1e-6), Verdict::drift_contradicts);
  EXPECT_EQ(with(&Certificate::taylor_closure, 1e-6), Verdict::wrong_period) << "what is beside the flow is explained";
  EXPECT_EQ(with(&Certificate::apart, 1e-6), Verdict::integrators_differ);
  EXPECT_EQ(with(&Certificate::single_shot, 1e-4), Verdict::return_contradicts);
  EXPECT_EQ(with(&Certificate::symmetry_defect, 1e-7), Verdict::not_symmetric);
  EXPECT_EQ(with(&Certificate::recurrence, 1e-11), Verdict::not_minimal);
  EXPECT_EQ(with(&Certificate::tail, 1e-3), Verdict::truncated);
  EXPECT_EQ(with(&Certificate::pairing, 1e-5), Verdict::unpaired);
  EXPECT_EQ(with(&Certificate::index, 2.5001), Verdict::other_multipliers);
  EXPECT_EQ(with(&Certificate::distance, 1e-3), Verdict::no_orbit_near);
  EXPECT_EQ(with(&Certificate::contraction, 0.9), Verdict::holds) << "two steps of rounding";
  Certificate aimless = whole();
  aimless.contraction = 0.9;
  aimless.distance = 1e-5;
  EXPECT_EQ(judge(aimless, evidence).verdict, Verdict::no_orbit_near);
}

// The multipliers let nothing be integrated, but Newton's method follows the orbit from segment to segment.
TEST(Verdict, OfAnUnstableOrbitIsNewtons) {
  Certificate certificate = whole();
  certificate.closure = certificate.taylor_closure = certificate.beside_flow = certificate.single_shot = 1e-3;
  certificate.index = 1e12;
  const Evidence evidence{10.0, 1e-12, 1.0, 1e12, 1e12, 1.0};
  EXPECT_EQ(judge(certificate, evidence).verdict, Verdict::holds);
  certificate.distance = unknown;
  EXPECT_EQ(judge(certificate, evidence).verdict, Verdict::says_nothing);
}

TEST(Verdict, EachHasAName) {
  for (int n = 0; n <= static_cast<int>(last_of(Verdict{})); ++n)
    EXPECT_NE(name_of(static_cast<Verdict>(n)), "unknown") << n;
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
}  // namespace orbweaver::certificate::verdict_test
