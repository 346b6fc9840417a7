#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "loss/cases.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::loss::exact_orbits_test {
namespace {

using test::two_pi;
using test::vector_of;
using test::view;

// q = A cos(wt) + B sin(wt), p = dq/dt.
loop::Loop oscillation(double omega, int cutoff, int harmonic = 1) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, harmonic * two_pi / omega, cutoff);
  loop.cosine(harmonic, 0) = 0.8;
  loop.sine(harmonic, 0) = -0.3;
  loop.cosine(harmonic, 1) = -0.3 * omega;
  loop.sine(harmonic, 1) = -0.8 * omega;
  return loop;
}

Unknowns all_of(const loop::Loop& loop) {
  return {loop::Subspace::unrestricted(loop.dimension, loop.cutoff), {Scalar::period()}};
}

void expect_exact(const systems::System& system, const loop::Loop& loop) {
  const Linearization here(system, loop, Linearization::Order::second);
  const Unknowns unknowns = all_of(loop);
  EXPECT_LT(std::sqrt(here.loss()), 1e-14);
  EXPECT_LT(vector_of(here.gradient(unknowns)).norm(), 1e-13);
  for (const std::uint64_t seed : {1u, 2u}) {
    const Eigen::VectorXd v = test::unit_direction(unknowns.size(), seed);
    const Eigen::VectorXd full = vector_of(here.apply_hessian(unknowns, view(v), Curvature::full));
    const Eigen::VectorXd gauss_newton = vector_of(here.apply_hessian(unknowns, view(v), Curvature::gauss_newton));
    EXPECT_GT(full.norm(), 0.1);
    EXPECT_LT((full - gauss_newton).norm(), 1e-13 * full.norm());
  }
}

TEST(ExactOrbits, OfTheHarmonicOscillator) {
  for (const double omega : {1.0, 2.5}) {
    const auto system = systems::make_system("harmonic_oscillator", {{"omega", omega}});
    expect_exact(*system, oscillation(omega, 1));
    expect_exact(*system, oscillation(omega, 6));
    expect_exact(*system, oscillation(omega, 6, 3));
  }
}

TEST(ExactOrbits, EquilibriaAreOrbitsOfEveryPeriod) {
  const auto pendulum = systems::make_system("double_pendulum");
  for (const double period : {0.5, 3.0, 20.0})
    for (const std::vector<double>& point :
         {std::vector<double>{0.0, 0.0, 0.0, 0.0}, {0.0, std::numbers::pi, 0.0, 0.0}})
      expect_exact(*pendulum, loop::constant_loop(point, period, 4));
}

TEST(ExactOrbits, AreFlatUnderATimeShiftAndAnAmplitude) {
  const auto system = systems::make_system("harmonic_oscillator");
  const loop::Loop loop = oscillation(1.0, 4);
  const Unknowns unknowns = all_of(loop);
  const Linearization here(*system, loop, Linearization::Order::jacobian);
  const std::vector<double> shift = unknowns.time_shift_direction(loop);
  EXPECT_LT(vector_of(here.apply_jacobian(unknowns, shift)).norm(), 1e-14);
  const std::vector<double> growth =
      unknowns.difference(loop::constant_loop(std::vector<double>{0.0, 0.0}, loop.period, 4), loop);
  EXPECT_LT(vector_of(here.apply_jacobian(unknowns, growth)).norm(), 1e-14);
  std::vector<double> longer(shift.size(), 0.0);
  longer.back() = 1.0;
  EXPECT_GT(vector_of(here.apply_jacobian(unknowns, longer)).norm(), 0.05) << "another period is no orbit";
}

// A wrong period leaves r = (2 pi / T - omega) (q', p') / omega: the loss is known in closed form.
TEST(ExactOrbits, LossOfAWrongPeriod) {
  const auto system = systems::make_system("harmonic_oscillator");
  loop::Loop loop = oscillation(1.0, 5);
  loop.period = 5.0;
  const double rate = two_pi / 5.0;
  const double expected = (rate - 1.0) * (rate - 1.0) * (0.8 * 0.8 + 0.3 * 0.3);
  EXPECT_NEAR(Linearization(*system, loop, Linearization::Order::residual).loss(), expected, 1e-15);
}

}  // namespace
}  // namespace orbweaver::loss::exact_orbits_test
