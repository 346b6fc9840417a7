// One curve under the identity and under a time map: the loss, its gradient along a change of the curve and of the
// period, and the direction of a time shift are those of the curve.
#include <cmath>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "loss/cases.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::loss::mapped_test {
namespace {

using Order = Linearization::Order;

constexpr int even_cutoff = 60;
constexpr int mapped_cutoff = 250;

std::vector<loop::TimeMap> maps() {
  return {{1.7, {}}, {0.6, {}}, {3.0, {}}, {1.0, {0.3, -0.2, 0.0, 0.1}}, {1.4, {0.05, 0.1, -0.1, 0.0, 0.02, 0.03}}};
}

loop::Loop even_loop(std::uint64_t seed) {
  loop::Loop loop = loop::with_cutoff(test::random_loop(4, 8, seed, 3.3, 0.4), even_cutoff);
  loop.winding = {1.0, 0.0, 0.0, 0.0};
  return loop;
}

Unknowns all_of(const loop::Loop& loop) {
  return {loop::Subspace::unrestricted(loop.dimension, loop.cutoff), {Scalar::period()}};
}

// The unknowns that change `from` to `to`, but for the windings that both share.
Eigen::VectorXd change(const loop::Loop& from, const loop::Loop& to) {
  return test::vector_of(all_of(from).difference(from, to));
}

TEST(MappedLoss, IsThatOfTheCurve) {
  const auto system = systems::make_system("double_pendulum");
  const loop::Loop even = even_loop(51);
  const double expected = Linearization(*system, even, Order::residual).loss();
  ASSERT_GT(expected, 1.0);
  for (const loop::TimeMap& map : maps()) {
    const loop::Loop mapped = loop::with_time_map(even, map, mapped_cutoff);
    EXPECT_NEAR(Linearization(*system, mapped, Order::residual).loss(), expected, 1e-12 * expected) << map.kappa;
  }
}

// dL and d2L along the same change of the curve, with a change of the period.
TEST(MappedLoss, HasTheSameDerivativesAlongAChangeOfTheCurve) {
  const auto system = systems::make_system("double_pendulum");
  const loop::Loop even = even_loop(52);
  loop::Loop there = even_loop(53);
  there.period = 4.0;
  const Linearization here(*system, even, Order::second);
  const Eigen::VectorXd v = change(even, there);
  const double slope = test::vector_of(here.gradient(all_of(even))).dot(v);
  const double bend = v.dot(test::vector_of(here.apply_hessian(all_of(even), test::view(v), Curvature::full)));
  for (const loop::TimeMap& map : maps()) {
    const loop::Loop mapped = loop::with_time_map(even, map, mapped_cutoff);
    const Eigen::VectorXd w = change(mapped, loop::with_time_map(there, map, mapped_cutoff));
    const Linearization lin(*system, mapped, Order::second);
    const Unknowns unknowns = all_of(mapped);
    EXPECT_NEAR(test::vector_of(lin.gradient(unknowns)).dot(w), slope, 1e-11 * std::abs(slope)) << map.kappa;
    EXPECT_NEAR(w.dot(test::vector_of(lin.apply_hessian(unknowns, test::view(w), Curvature::full))), bend,
                1e-11 * std::abs(bend))
        << map.kappa;
  }
}

TEST(MappedLoss, NodesSuffice) {
  const auto system = systems::make_system("double_pendulum");
  const loop::Loop even = even_loop(54);
  const double expected = Linearization(*system, even, Order::residual).loss();
  for (const double kappa : {1.5, 4.0, 10.0, 25.0}) {
    const loop::Loop mapped = loop::with_time_map(even, {kappa, {}}, static_cast<int>(100 * kappa));
    ASSERT_LT(loop::tail(mapped), 1e-13) << kappa;
    EXPECT_NEAR(Linearization(*system, mapped, Order::residual).loss(), expected, 1e-12 * expected) << kappa;
    EXPECT_EQ(Linearization(*system, mapped, Order::residual).nodes(), loop::nodes_for(mapped));
  }
}

TEST(MappedLoss, TimeShiftDirectionIsTheDerivativeOfATimeShift) {
  const loop::Loop even = even_loop(55);
  for (const loop::TimeMap& map : maps()) {
    const loop::Loop mapped = loop::with_time_map(even, map, mapped_cutoff);
    const Eigen::VectorXd direction = test::vector_of(all_of(mapped).time_shift_direction(mapped));
    const auto shifted = [&](double ds) {
      return loop::with_time_map(loop::time_shifted(even, ds / test::two_pi), map, mapped_cutoff);
    };
    constexpr double ds = 1e-4;
    const Eigen::VectorXd difference = change(shifted(-ds), shifted(ds)) / (2.0 * ds);
    EXPECT_LT((direction - difference).norm(), 1e-6 * direction.norm()) << map.kappa;
    EXPECT_EQ(direction(direction.size() - 1), 0.0);
  }
}

TEST(MappedLoss, IsFlatAlongATimeShiftOfAnOrbit) {
  const auto system = systems::make_system("harmonic_oscillator");
  loop::Loop even = loop::constant_loop(std::vector<double>{0.0, 0.0}, test::two_pi, 1);
  even.cosine(1, 0) = 0.8;
  even.sine(1, 1) = -0.8;
  for (const loop::TimeMap& map : maps()) {
    constexpr int cutoff = 100;
    const double rounding = 4.0 * 2.2e-16 * cutoff * cutoff;  // of the derivative of a derivative
    const loop::Loop mapped = loop::with_time_map(even, map, cutoff);
    const Unknowns unknowns = all_of(mapped);
    const Linearization lin(*system, mapped, Order::jacobian);
    EXPECT_LT(std::sqrt(lin.loss()), 1e-13) << map.kappa;
    const std::vector<double> shift = unknowns.time_shift_direction(mapped);
    EXPECT_LT(test::vector_of(lin.apply_jacobian(unknowns, shift)).norm(), rounding) << map.kappa;
    EXPECT_GT(test::vector_of(shift).norm(), 0.1);
  }
}

TEST(MappedLossMisuse, LoopsUnderDifferentMapsHaveNoDifference) {
  const loop::Loop even = even_loop(56);
  loop::Loop mapped = even;
  mapped.time_map.kappa = 2.0;
  EXPECT_THROW(static_cast<void>(all_of(even).difference(even, mapped)), core::MisuseError);
  mapped.time_map = {1.0, {1.2, 0.0}};
  const auto system = systems::make_system("double_pendulum");
  EXPECT_THROW(Linearization(*system, mapped, Order::residual), core::MisuseError) << "time runs backwards";
}

}  // namespace
}  // namespace orbweaver::loss::mapped_test
