#include "orbweaver/continuation/off_branch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loss/matrices.hpp"
#include "orbweaver/spectrum/sliced_hessian.hpp"
#include "spectrum/matrices.hpp"

namespace orbweaver::continuation {
namespace {

/// An orbit of a family with the direction in which the family goes on.
struct OnFamily {
  loop::Loop loop;
  std::vector<double> tangent_modes;
  double tangent_period = 0.0;

  [[nodiscard]] double off_branch_eigenvalue(const loop::Isotropy& isotropy) const {
    return continuation::off_branch_eigenvalue(*test::pendulum(), loop, isotropy, tangent_modes, tangent_period);
  }
  [[nodiscard]] double off_branch_eigenvalue() const {
    return off_branch_eigenvalue(test::pendulum_isotropy(*test::pendulum()));
  }
};

OnFamily at_period(const test::PendulumMode& mode, double period) {
  const corrector::Result orbit = test::orbit_at(test::family_to_twelve(mode), period);
  EXPECT_TRUE(orbit.converged()) << orbit.detail;
  const loss::Unknowns unknowns{loop::Subspace(4, orbit.loop.cutoff, test::pendulum_isotropy(*test::pendulum())), true};
  const Eigen::VectorXd normal = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
  const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::jacobian);
  const Eigen::VectorXd flat =
      spectrum::SlicedHessian(linearization, unknowns, loss::Slice(unknowns.size(), normal)).flat_direction(normal);
  OnFamily out{orbit.loop, std::vector<double>(orbit.loop.modes.size(), 0.0), flat(flat.size() - 1)};
  unknowns.subspace.add_to(std::span(flat.data(), static_cast<std::size_t>(unknowns.subspace.size())),
                           out.tangent_modes);
  return out;
}

/// The same number by brute force: H over all coefficients and T, the two known flat directions projected out and moved
/// to the top of the spectrum.
double by_dense_projection(const OnFamily& orbit) {
  const loss::Unknowns unknowns{loop::Subspace::unrestricted(4, orbit.loop.cutoff), true};
  const loss::Linearization linearization(*test::pendulum(), orbit.loop, loss::Linearization::Order::jacobian);
  const Eigen::MatrixXd j = test::to_dense(loss::assemble_jacobian(linearization, unknowns));
  const Eigen::MatrixXd h = 2.0 * j.transpose() * j;
  Eigen::MatrixXd flat(unknowns.size(), 2);
  std::vector<double> tangent(static_cast<std::size_t>(unknowns.size()));
  unknowns.subspace.project(orbit.tangent_modes,
                            std::span(tangent).first(static_cast<std::size_t>(unknowns.subspace.size())));
  tangent.back() = orbit.tangent_period;
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
}  // namespace orbweaver::continuation
