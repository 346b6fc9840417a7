#include "orbweaver/continuation/off_branch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/spectrum/sliced_hessian.hpp"
#include "spectrum/matrices.hpp"
#include "support/off_branch_triplets.hpp"

namespace orbweaver::continuation::off_branch_test {
namespace {

/// An orbit of a family with the direction in which the family goes on.
struct OnFamily {
  loop::Loop loop;
  loop::Tangent tangent;

  [[nodiscard]] double off_branch_eigenvalue(const loop::Isotropy& isotropy) const {
    return continuation::off_branch_eigenvalue(*test::pendulum(), loop, isotropy, tangent);
  }
  [[nodiscard]] double off_branch_eigenvalue(int krylov_from) const {
    return continuation::off_branch_eigenvalue(*test::pendulum(), loop, test::pendulum_isotropy(*test::pendulum()),
                                               tangent, krylov_from);
  }
  [[nodiscard]] std::vector<OffBranchTriplet> triplets(const spectrum::TripletOptions& options, bool split) const {
    const loop::Isotropy isotropy = split ? test::pendulum_isotropy(*test::pendulum()) : loop::Isotropy{};
    return test::off_branch_triplets(*test::pendulum(), loop, isotropy, tangent, options);
  }
  [[nodiscard]] double off_branch_eigenvalue() const {
    return off_branch_eigenvalue(test::pendulum_isotropy(*test::pendulum()));
  }
};

OnFamily at_period(const test::PendulumMode& mode, double period) {
  const corrector::Result orbit = test::orbit_at(test::even_family_to_twelve(mode), period);
  EXPECT_TRUE(orbit.converged()) << orbit.detail;
  const loss::Unknowns unknowns{loop::Subspace(4, orbit.loop.cutoff, test::pendulum_isotropy(*test::pendulum())),
                                {loss::Scalar::period()}};
  const Eigen::VectorXd normal = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
  const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::jacobian);
  const Eigen::VectorXd flat =
      spectrum::SlicedHessian(linearization, unknowns, loss::Slice(unknowns.size(), normal)).flat_direction(normal);
  return {orbit.loop, unknowns.tangent_of(std::span(flat.data(), static_cast<std::size_t>(flat.size())))};
}

/// The same number by brute force: H over all coefficients and T, the two known flat directions projected out and moved
/// to the top of the spectrum.
double by_dense_projection(const OnFamily& orbit) {
  const loss::Unknowns unknowns{loop::Subspace::unrestricted(4, orbit.loop.cutoff), {loss::Scalar::period()}};
  const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::jacobian);
  const Eigen::MatrixXd j = test::to_dense(loss::assemble_jacobian(linearization, unknowns));
  const Eigen::MatrixXd h = 2.0 * j.transpose() * j;
  Eigen::MatrixXd flat(unknowns.size(), 2);
  const std::vector<double> tangent = unknowns.coordinates_of(orbit.tangent);
  const std::vector<double> shift = unknowns.time_shift_direction(orbit.loop);
  for (int n = 0; n < unknowns.size(); ++n) {
    flat(n, 0) = tangent[static_cast<std::size_t>(n)];
    flat(n, 1) = shift[static_cast<std::size_t>(n)];
  }
  EXPECT_LT((h * flat.col(0)).norm(), 1e-9 * flat.col(0).norm());
  EXPECT_LT((h * flat.col(1)).norm(), 1e-9 * flat.col(1).norm());
  const Eigen::MatrixXd basis =
      Eigen::HouseholderQR<Eigen::MatrixXd>(flat).householderQ() * Eigen::MatrixXd::Identity(unknowns.size(), 2);
  const Eigen::MatrixXd projector =
      Eigen::MatrixXd::Identity(unknowns.size(), unknowns.size()) - basis * basis.transpose();
  const Eigen::MatrixXd projected = projector * h * projector + h.norm() * basis * basis.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(projected, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

TEST(OffBranchEigenvalue, IsThatOfADenseComputationInTheFullSpace) {
  for (const test::PendulumMode& mode : test::pendulum_modes()) {
    const OnFamily orbit = at_period(mode, 1.03 * mode.period());
    ASSERT_LE(orbit.loop.cutoff, 52) << mode.name;
    const double dense = by_dense_projection(orbit);
    EXPECT_GT(dense, 1e-7) << mode.name;
    EXPECT_NEAR(orbit.off_branch_eigenvalue(), dense, 1e-7 * dense + 1e-12) << mode.name;
  }
}

// Without a declared isotropy the whole space is taken at once.
TEST(OffBranchEigenvalue, DoesNotDependOnHowItIsSplit) {
  const OnFamily orbit = at_period(test::in_phase(), 8.5);
  const double split = orbit.off_branch_eigenvalue();
  EXPECT_NEAR(orbit.off_branch_eigenvalue({}), split, 1e-6 * split);
  loop::Isotropy one = test::pendulum_isotropy(*test::pendulum());
  one.pop_back();
  EXPECT_NEAR(orbit.off_branch_eigenvalue(one), split, 1e-6 * split);
}

// The number is that of the orbit, not of the coefficients that a time map gives it.
TEST(OffBranchEigenvalue, DoesNotDependOnTheTimeMap) {
  const OnFamily orbit = at_period(test::in_phase(), 8.5);
  const double even = orbit.off_branch_eigenvalue();
  for (const loop::TimeMap& map : {loop::TimeMap{1.5, {}}, loop::TimeMap{1.0, {0.0, 0.0, 0.2, 0.0}}}) {
    const OnFamily mapped{loop::with_time_map(orbit.loop, map, 77),
                          loop::with_time_map(orbit.loop, orbit.tangent, map, 77)};
    EXPECT_NEAR(mapped.off_branch_eigenvalue(), even, 1e-6 * even);
  }
}

constexpr int always_dense = 1 << 30;

TEST(OffBranchEigenvalue, IsTheSameMatrixFree) {
  for (const test::PendulumMode& mode : test::pendulum_modes()) {
    const OnFamily orbit = at_period(mode, 1.2 * mode.period());
    const double dense = orbit.off_branch_eigenvalue(always_dense);
    EXPECT_NEAR(orbit.off_branch_eigenvalue(1), dense, 1e-7 * dense) << mode.name;
    EXPECT_NE(orbit.off_branch_eigenvalue(1), dense) << mode.name << ": both by the same way";
  }
}

TEST(OffBranchTriplets, AreTheSameDenseMatrixFreeSplitAndWhole) {
  for (const test::PendulumMode& mode : test::pendulum_modes()) {
    const OnFamily orbit = at_period(mode, 1.03 * mode.period());
    const std::vector<OffBranchTriplet> dense = orbit.triplets({.count = 2, .krylov_from = always_dense}, false);
    const std::vector<OffBranchTriplet> split = orbit.triplets({.count = 2, .krylov_from = 1}, true);
    const std::vector<OffBranchTriplet> whole = orbit.triplets({.count = 2, .krylov_from = 1}, false);
    ASSERT_TRUE(dense.size() == 2 && split.size() == 2 && whole.size() == 2);
    const double eigenvalue = orbit.off_branch_eigenvalue(always_dense);
    EXPECT_NEAR(2.0 * std::pow(dense[0].singular_value, 2), eigenvalue, 1e-7 * eigenvalue) << mode.name;
    for (std::size_t n = 0; n < 2; ++n) {
      const double sigma = dense[n].singular_value;
      EXPECT_NEAR(split[n].singular_value, sigma, 1e-7 * sigma) << mode.name << n;
      EXPECT_NEAR(whole[n].singular_value, sigma, 1e-7 * sigma) << mode.name << n;
      EXPECT_LT(whole[n].residual + whole[n].left_residual, 1e-5 * sigma) << mode.name << n;
      EXPECT_TRUE(whole[n].signs.empty());
    }
  }
}

// v is orthogonal to what is known to be flat, of unit length, in the sector that its signs name, and |J v| = sigma.
TEST(OffBranchTriplets, AreDirections) {
  const OnFamily orbit = at_period(test::in_phase(), 9.0);
  const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::jacobian);
  const loss::Unknowns all{loop::Subspace::unrestricted(4, orbit.loop.cutoff), {loss::Scalar::period()}};
  const auto whole = [&](const loop::Tangent& t) {
    const std::vector<double> u = all.coordinates_of(t);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(u.data(), all.size()));
  };
  const Eigen::VectorXd tangent = whole(orbit.tangent).normalized();
  const std::vector<double> shift = all.time_shift_direction(orbit.loop);
  for (const OffBranchTriplet& t : orbit.triplets({.count = 6}, true)) {
    const Eigen::VectorXd v = whole(t.direction);
    EXPECT_NEAR(v.norm(), 1.0, 1e-12);
    EXPECT_LT(std::abs(v.dot(tangent)), 1e-12);
    EXPECT_LT(std::abs(v.dot(Eigen::Map<const Eigen::VectorXd>(shift.data(), v.size()))), 1e-12);
    const std::vector<double> jv =
        linearization.apply_jacobian(all, std::span(v.data(), static_cast<std::size_t>(v.size())));
    EXPECT_NEAR(Eigen::Map<const Eigen::VectorXd>(jv.data(), linearization.rows()).norm(), t.singular_value,
                1e-7 * t.singular_value);
    ASSERT_EQ(t.signs.size(), 2u);
    const loop::Subspace sector(4, orbit.loop.cutoff, test::pendulum_isotropy(*test::pendulum()), t.signs);
    Eigen::VectorXd inside(sector.size());
    sector.project(t.direction.modes, std::span(inside.data(), static_cast<std::size_t>(inside.size())));
    EXPECT_NEAR(inside.squaredNorm() + t.direction.period() * t.direction.period(), 1.0, 1e-12);
  }
}

TEST(OffBranchTriplets, BreakASymmetryWhereAFamilyOfTheSamePeriodCrosses) {
  const OnFamily orbit = at_period(test::in_phase(), 10.416773281973249);
  const std::vector<OffBranchTriplet> found = orbit.triplets({.count = 2}, true);
  EXPECT_LT(found[0].singular_value, 1e-10);
  EXPECT_GT(found[1].singular_value, 1e-3);
  EXPECT_EQ(found[0].signs, (std::vector<int>{1, -1}));
  EXPECT_EQ(found[0].direction.period(), 0.0);
}

// At a crossing a second direction is flat: the eigenvalue, quadratic in the distance, falls to rounding.
TEST(OffBranchEigenvalue, VanishesWhereAnotherFamilyCrossesInPhase) {
  const double period = 10.416773281973249;
  const double at_crossing = at_period(test::in_phase(), period).off_branch_eigenvalue();
  double beside[2];
  for (int side = 0; side < 2; ++side)
    beside[side] = at_period(test::in_phase(), period + (side == 0 ? -0.05 : 0.05)).off_branch_eigenvalue();
  EXPECT_LT(std::abs(at_crossing), 1e-6 * std::min(beside[0], beside[1])) << beside[0] << " " << beside[1];
  const double further = at_period(test::in_phase(), period + 0.1).off_branch_eigenvalue();
  EXPECT_NEAR(further / beside[1], 4.0, 0.5);
}

TEST(OffBranchEigenvalue, DipsWhereAnotherFamilyCrossesOutPhase) {
  const auto value = [](double period) { return at_period(test::out_phase(), period).off_branch_eigenvalue(); };
  const double left = value(6.05);
  const double right = value(6.25);
  double low = 6.05;
  double high = 6.25;
  while (high - low > 2e-5) {  // ternary search: the only minimum in between
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    const bool lower_half = value(a) < value(b);
    (lower_half ? high : low) = lower_half ? b : a;
  }
  EXPECT_NEAR(0.5 * (low + high), 6.1476, 1e-3);
  EXPECT_LT(value(0.5 * (low + high)), 1e-6 * std::min(left, right))
      << left << " " << right << " at " << 0.5 * (low + high);
}

TEST(OffBranchEigenvalue, IsStoredWithEveryOrbitIfAsked) {
  const test::Trace trace = test::trace_of(test::in_phase(), {.period_limit = 8.5, .off_branch_spectrum = true});
  for (const Orbit& orbit : trace.orbits) EXPECT_GT(orbit.off_branch_eigenvalue, 1e-7) << orbit.loop.period;
  const OnFamily last = at_period(test::in_phase(), 8.5);
  EXPECT_NEAR(trace.last().off_branch_eigenvalue, last.off_branch_eigenvalue(), 0.01 * last.off_branch_eigenvalue());
}

}  // namespace
}  // namespace orbweaver::continuation::off_branch_test
