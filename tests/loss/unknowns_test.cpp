#include "orbweaver/loss/unknowns.hpp"

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loss::unknowns_test {
namespace {

using loop::Loop;
using loop::Subspace;

Unknowns free_unknowns(bool period = true) {
  Unknowns unknowns{Subspace::unrestricted(3, 5), {}};
  if (period) unknowns.scalars.push_back(Scalar::period());
  return unknowns;
}

Loop base_loop() {
  Loop loop = test::random_loop(3, 5, 91);
  loop.winding = {2.0, 0.0, 0.0};
  return loop;
}

TEST(Unknowns, CountTheirPeriod) {
  EXPECT_EQ(free_unknowns(true).size(), 34);
  EXPECT_EQ(free_unknowns(false).size(), 33);
}

TEST(Unknowns, DifferenceUndoesMoved) {
  const loop::Isotropy mirror{test::element_of(test::structure_of("henon_heiles"), "C", 1, 3)};
  const Unknowns unknowns{Subspace(4, 5, mirror), {Scalar::period()}};
  const Loop base = test::random_loop(4, 5, 92);
  const std::vector<double> u = test::random_values(static_cast<std::size_t>(unknowns.size()), 93);
  const Loop moved = unknowns.moved(base, u);
  EXPECT_DOUBLE_EQ(moved.period, base.period + u.back());
  EXPECT_LT(test::distance(unknowns.difference(base, moved), u), 1e-14);
  EXPECT_EQ(unknowns.moved(base, std::vector<double>(u.size(), 0.0)).modes, base.modes);
}

TEST(Unknowns, HoldThePeriodWhereItIsNotUnknown) {
  const Loop base = base_loop();
  const Loop moved = free_unknowns(false).moved(base, std::vector<double>(33, 0.1));
  EXPECT_EQ(moved.period, base.period);
  EXPECT_NEAR(moved.modes[7] - base.modes[7], 0.1, 1e-15);
  EXPECT_EQ(moved.winding, base.winding);
}

TEST(Unknowns, LetThePeriodBecomeAnything) {
  std::vector<double> u(34, 0.0);
  u.back() = -100.0;
  EXPECT_LT(free_unknowns().moved(base_loop(), u).period, 0.0);
}

TEST(Unknowns, DifferenceIsAProjection) {
  const loop::Isotropy mirror{test::element_of(test::structure_of("double_pendulum"), "S", 1, 2)};
  const Unknowns unknowns{Subspace(4, 5, mirror), {}};
  const Loop from = test::random_loop(4, 5, 94);
  const Loop to = test::random_loop(4, 5, 95);
  const Loop nearest = unknowns.moved(from, unknowns.difference(from, to));
  for (const double other : unknowns.difference(nearest, to)) EXPECT_NEAR(other, 0.0, 1e-14);
  EXPECT_GT(loop::mean_distance(nearest, to), 1e-2) << "`to` does not lie in the subspace";
}

TEST(Unknowns, TimeShiftDirectionIsTheDerivativeOfATimeShift) {
  const Loop base = base_loop();
  const Unknowns unknowns = free_unknowns();
  const std::vector<double> direction = unknowns.time_shift_direction(base);
  EXPECT_EQ(direction.back(), 0.0);
  const auto error = [&](double ds) {
    const std::vector<double> later = unknowns.difference(base, loop::time_shifted(base, ds / test::two_pi));
    std::vector<double> predicted = direction;
    for (double& d : predicted) d *= ds;
    return test::distance(later, predicted);
  };
  double last = error(1e-2);
  for (const double ds : {5e-3, 2.5e-3, 1.25e-3}) {
    const double next = error(ds);
    EXPECT_NEAR(std::log2(last / next), 2.0, 0.05);
    last = next;
  }
}

// A reversor fixes the phase: no time shift keeps it.
TEST(Unknowns, ReversibleSubspaceHasNoTimeShift) {
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  const loop::Isotropy brake{test::element_of(pendulum, "R")};
  const Unknowns unknowns{Subspace(4, 5, brake), {Scalar::period()}};
  const Loop loop =
      test::random_loop_in(unknowns.subspace, loop::constant_loop(std::vector<double>(4, 0.0), 2.0, 5), 96);
  for (const double d : unknowns.time_shift_direction(loop)) EXPECT_EQ(d, 0.0);
}

TEST(UnknownsMisuse, WrongSizesAreRefused) {
  const Unknowns unknowns = free_unknowns();
  const Loop base = base_loop();
  EXPECT_THROW(static_cast<void>(unknowns.moved(base, std::vector<double>(33))), core::MisuseError);
  EXPECT_THROW(static_cast<void>(unknowns.moved(test::random_loop(3, 6, 91), std::vector<double>(34))),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(unknowns.moved(test::random_loop(4, 5, 91), std::vector<double>(34))),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(unknowns.difference(base, test::random_loop(3, 6, 91))), core::MisuseError);
  EXPECT_THROW(static_cast<void>(unknowns.difference(test::random_loop(3, 6, 91), test::random_loop(3, 6, 92))),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(unknowns.time_shift_direction(test::random_loop(3, 6, 91))), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loss::unknowns_test
