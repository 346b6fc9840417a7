#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/loop_solver.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/spectrum/loop_triplets.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/matrices.hpp"

namespace orbweaver::spectrum::loop_triplets_test {
namespace {

constexpr double crossing = 10.416773281973249;  // of the in-phase family with one of the same period
constexpr int always_dense = 1 << 30;

/// An orbit with perturbations in one sector of S@1/2 R@0 ("++", ..), or all of them; the slice pins the period and the
/// phase as far as they are there.
struct Problem {
  Problem(const loop::Loop& orbit, const std::string& sector)
      : loop(orbit), unknowns{subspace(sector), scalars(sector)}, slice(unknowns.size(), pinned()) {}

  [[nodiscard]] static std::vector<loss::Scalar> scalars(const std::string& sector) {
    if (sector == "all" || sector == "++") return {loss::Scalar::period()};
    return {};
  }
  [[nodiscard]] loop::Subspace subspace(const std::string& sector) const {
    if (sector == "all") return loop::Subspace::unrestricted(4, loop.cutoff);
    const std::vector<int> signs{sector[0] == '+' ? 1 : -1, sector[1] == '+' ? 1 : -1};
    return {4, loop.cutoff, test::pendulum_isotropy(*system), signs};
  }
  [[nodiscard]] Eigen::MatrixXd pinned() const {
    const std::vector<double> shift = unknowns.time_shift_direction(loop);
    const Eigen::VectorXd direction = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size());
    const bool phase = direction.norm() > 1e-8;
    Eigen::MatrixXd out(unknowns.size(), (unknowns.has_period() ? 1 : 0) + (phase ? 1 : 0));
    if (unknowns.has_period()) out.col(0) = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
    if (phase) out.rightCols(1) = direction.normalized();
    return out;
  }

  [[nodiscard]] SingularTriplets triplets(const TripletOptions& options) const {
    return smallest_singular_triplets(*system, loop, unknowns, slice, options);
  }
  [[nodiscard]] SingularTriplets matrix_free(int count) const { return triplets({.count = count, .krylov_from = 1}); }
  [[nodiscard]] SingularTriplets dense(int count) const {
    return triplets({.count = count, .krylov_from = always_dense});
  }
  [[nodiscard]] Eigen::MatrixXd jacobian() const {
    const loss::Linearization linearization(*system, loop, loss::Linearization::Order::jacobian);
    return test::to_dense(loss::assemble_jacobian(linearization, unknowns));
  }

  std::shared_ptr<const systems::System> system = test::pendulum();
  loop::Loop loop;
  loss::Unknowns unknowns;
  loss::Slice slice;
};

loop::Loop in_phase_at(double period) {
  const corrector::Result orbit = test::orbit_at(test::even_family_to_twelve(test::in_phase()), period);
  EXPECT_TRUE(orbit.converged()) << orbit.detail;
  // To rounding, not only to its tolerance: flat directions are as flat as the orbit is exact.
  const loop::Loop finer = loop::with_cutoff(orbit.loop, loop::next_cutoff(orbit.loop.cutoff));
  const corrector::Result exact =
      continuation::orbit_at_period(*test::pendulum(), finer, test::pendulum_isotropy(*test::pendulum()), period, {});
  EXPECT_TRUE(exact.converged()) << exact.detail;
  return exact.loop;
}

const std::vector<std::string> sectors{"++", "+-", "-+", "--"};

TEST(LoopTriplets, AreThoseOfTheDenseJacobian) {
  const loop::Loop orbit = in_phase_at(8.3);
  for (const std::string& sector : {std::string("all"), sectors[0], sectors[1], sectors[2], sectors[3]}) {
    const Problem problem(orbit, sector);
    const SingularTriplets dense = problem.dense(3);
    const SingularTriplets free = problem.matrix_free(3);
    ASSERT_EQ(dense.inner_iterations, 0);
    ASSERT_GT(free.inner_iterations, 0);
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_NEAR(free.values[n], dense.values[n], 1e-9 * dense.values[n]) << sector << n;
      const auto column = static_cast<Eigen::Index>(n);
      EXPECT_LT((free.right.col(column) - dense.right.col(column)).norm(), 1e-6) << sector << n;
      EXPECT_LT((free.left.col(column) - dense.left.col(column)).norm(), 1e-6) << sector << n;
    }
  }
}

TEST(LoopTriplets, HaveTheResidualsTheyReport) {
  const Problem problem(in_phase_at(8.3), "all");
  const Eigen::MatrixXd j = problem.jacobian();
  for (const SingularTriplets& triplets : {problem.matrix_free(2), problem.dense(2)}) {
    for (int n = 0; n < 2; ++n) {
      const auto at = static_cast<std::size_t>(n);
      const double sigma = triplets.values[at];
      const Eigen::VectorXd v = triplets.right.col(n);
      const Eigen::VectorXd u = triplets.left.col(n);
      const double residual = (j * v - sigma * u).norm();
      const double left_residual = problem.slice.reduce(j.transpose() * u - sigma * v).norm();
      EXPECT_NEAR(triplets.residuals[at], residual, 1e-12) << n;
      EXPECT_NEAR(triplets.left_residuals[at], left_residual, 1e-11) << n;
      EXPECT_LT(residual, 1e-6 * sigma) << n;
      EXPECT_LT(left_residual, 1e-6 * sigma) << n;
      EXPECT_LT((problem.slice.conditions().transpose() * v).norm(), 1e-14) << n;
    }
    EXPECT_LT((triplets.right.transpose() * triplets.right - Eigen::Matrix2d::Identity()).norm(), 1e-8);
    EXPECT_LT((triplets.left.transpose() * triplets.left - Eigen::Matrix2d::Identity()).norm(), 1e-8);
  }
}

/// The sector in which the crossing's kernel lies.
std::string flat_sector() {
  const loop::Loop orbit = in_phase_at(crossing);
  std::string flat;
  for (const std::string& sector : sectors)
    if (Problem(orbit, sector).matrix_free(1).values[0] < 1e-10) flat += sector;
  return flat;
}

// Beside the crossing sigma is 1e-9 |J|: five digits, by the dense Jacobian and by sigma being linear in the distance.
TEST(LoopTriplets, KeepFiveDigitsOfATinyValueWhoseSquareIsBelowTheRoundingOfH) {
  const std::string sector = flat_sector();
  ASSERT_EQ(sector.size(), 2u) << sector;
  const double distance = 8e-7;
  const Problem near(in_phase_at(crossing + distance), sector);
  const double norm = std::sqrt(0.5) * near.loop.cutoff * 2.0 * std::numbers::pi / near.loop.period;
  const SingularTriplets free = near.matrix_free(2);
  ASSERT_LT(free.values[0], 1.5e-9 * norm);
  ASSERT_GT(free.values[0], 0.5e-9 * norm);
  const SingularTriplets dense = near.dense(2);
  EXPECT_NEAR(free.values[0], dense.values[0], 5e-6 * free.values[0]);
  EXPECT_NEAR(free.values[1], dense.values[1], 1e-9 * free.values[1]);
  const SingularTriplets further = Problem(in_phase_at(crossing + 2.0 * distance), sector).matrix_free(1);
  EXPECT_NEAR(further.values[0] / free.values[0], 2.0, 2e-5);

  const loss::Linearization linearization(*near.system, near.loop, loss::Linearization::Order::jacobian);
  const auto h =
      near.slice.reduce_symmetric(loss::assemble_hessian(linearization, near.unknowns, loss::Curvature::gauss_newton));
  PetscReal largest = 0.0;
  core::check(MatNorm(h.get(), NORM_INFINITY, &largest), "MatNorm");
  EXPECT_LT(2.0 * free.values[0] * free.values[0], 0.1 * std::numeric_limits<double>::epsilon() * largest);
}

// The residual's rounding grows with the solution, which beside a kernel is 1e10 times the right side and more: GMRES
// meets no share of the right side there, and its solution is the null vector all the same.
TEST(LoopTriplets, SolvesBesideAFlatDirectionAreJudgedByTheirSolution) {
  const std::string flat = flat_sector();
  ASSERT_EQ(flat.size(), 2u) << flat;
  const double out_of_reach = 1e-30;
  for (const std::string& sector : {flat, std::string("--")}) {
    const Problem problem(in_phase_at(crossing), sector);
    const loop::Subspace image = problem.unknowns.subspace.image();
    equations::LoopEquations equations(*problem.system, problem.loop, problem.unknowns, image, problem.slice);
    equations.factor(*problem.system, problem.loop);
    equations::LoopSolver solver(equations.size(), "test_");
    Eigen::VectorXd b(equations.size());
    for (Eigen::Index n = 0; n < b.size(); ++n) b(n) = std::cos(1.0 + 2.0 * static_cast<double>(n));
    const double share = 1e-9 * equations.linearization().rate();
    EXPECT_THROW((void)solver.solve(equations, b, {1e-7, out_of_reach}), core::NumericalError) << sector;
    if (sector != flat) {
      EXPECT_THROW((void)solver.solve(equations, b, {1e-7, out_of_reach, share}), core::NumericalError) << sector;
      continue;
    }
    const Eigen::VectorXd x = solver.solve(equations, b, {1e-7, out_of_reach, share}).normalized();
    Eigen::VectorXd ax(x.size());
    equations.apply(x, ax);
    EXPECT_LT(ax.norm(), 2.0 * share);
    const Eigen::VectorXd v = problem.dense(1).right.col(0);
    EXPECT_NEAR(std::abs(v.dot(x.head(v.size()))), 1.0, 1e-8);
  }
}

// Where the smallest value is 0 to rounding, solves hold nothing but its vector: the next one must come out all the
// same.
TEST(LoopTriplets, FindTheNextValuesBesideAFlatDirection) {
  Problem problem(in_phase_at(9.0), "+-");
  const Eigen::VectorXd shift = problem.slice.conditions().col(0);
  const SingularTriplets without = problem.dense(2);
  problem.slice = loss::Slice(problem.unknowns.size(), Eigen::MatrixXd(problem.unknowns.size(), 0));
  const SingularTriplets free = problem.matrix_free(3);
  EXPECT_LT(free.values[0], 1e-10);
  EXPECT_NEAR(std::abs(free.right.col(0).dot(shift)), 1.0, 1e-10);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(free.values[n + 1], without.values[n], 1e-8 * without.values[n]) << n;
    const auto column = static_cast<Eigen::Index>(n);
    EXPECT_LT((free.right.col(column + 1) - without.right.col(column)).norm(), 1e-5) << n;
  }
}

// Every amplitude of the harmonic oscillator is an orbit of the same period: with T pinned J is singular to rounding.
TEST(LoopTriplets, FindTheNextValuesBesideAnExactlyFlatDirection) {
  Problem problem(in_phase_at(8.3), "all");
  problem.system = systems::make_system("harmonic_oscillator");
  problem.loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0 * std::numbers::pi, 40);
  problem.loop.cosine(1, 0) = 0.7;
  problem.loop.sine(1, 1) = -0.7;
  problem.unknowns = {loop::Subspace::unrestricted(2, 40), {loss::Scalar::period()}};
  problem.slice = loss::Slice(problem.unknowns.size(), problem.pinned());
  const SingularTriplets free = problem.triplets({.count = 4, .multiple = true, .krylov_from = 1});
  const SingularTriplets dense = problem.dense(4);
  EXPECT_LT(free.values[0], 1e-13);
  ASSERT_NEAR(dense.values[1], dense.values[2], 1e-12) << "a double value";
  for (std::size_t n = 1; n < 4; ++n) EXPECT_NEAR(free.values[n], dense.values[n], 1e-8 * dense.values[n]) << n;
}

// Nothing is flat there: what is expected to be is not taken for granted, and no value is passed over.
TEST(LoopTriplets, ExpectedFlatDirectionsThatAreNotThereChangeNothing) {
  const Problem problem(in_phase_at(8.3), "all");
  const SingularTriplets dense = problem.dense(3);
  const SingularTriplets free = problem.triplets({.count = 3, .nearly_flat = 2, .krylov_from = 1});
  ASSERT_GT(dense.values[0], 1e-4);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(free.values[n], dense.values[n], 1e-9 * dense.values[n]) << n;
}

// At the crossing one direction is flat, whether one, two or none are expected to be. Where they are, solves see a
// regular matrix, and take as many iterations as beside any orbit: without that, several times as many.
TEST(LoopTriplets, ExpectedFlatDirectionsAreFoundWithFewIterations) {
  const loop::Loop orbit = in_phase_at(crossing);
  for (const std::string& sector : {flat_sector(), std::string("all")}) {
    const Problem problem(orbit, sector);
    const SingularTriplets dense = problem.dense(3);
    ASSERT_LT(dense.values[0], 1e-10) << sector;
    const SingularTriplets unexpected = problem.matrix_free(3);
    for (const int expected : {1, 2}) {
      const SingularTriplets free = problem.triplets({.count = 3, .nearly_flat = expected, .krylov_from = 1});
      EXPECT_LT(free.values[0], 1e-10) << sector << expected;
      EXPECT_NEAR(std::abs(free.right.col(0).dot(dense.right.col(0))), 1.0, 1e-9) << sector << expected;
      EXPECT_LT(free.left_residuals[0], 1e-9) << sector << expected;
      for (std::size_t n = 1; n < 3; ++n)
        EXPECT_NEAR(free.values[n], dense.values[n], 1e-8 * dense.values[n]) << sector << expected << n;
      EXPECT_LT(2 * free.inner_iterations, unexpected.inner_iterations) << sector << expected;
    }
  }
}

// Orbits of the harmonic oscillator have one period: the amplitude and the time shift are flat. One is expected, so
// that A is singular with what is added to it, too.
TEST(LoopTriplets, MoreFlatDirectionsThanExpectedAreAllFound) {
  Problem problem(in_phase_at(8.3), "all");
  problem.system = systems::make_system("harmonic_oscillator");
  problem.loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0 * std::numbers::pi, 40);
  problem.loop.cosine(1, 0) = 0.7;
  problem.loop.sine(1, 1) = -0.7;
  problem.unknowns = {loop::Subspace::unrestricted(2, 40), {}};
  problem.slice = loss::Slice(problem.unknowns.size(), Eigen::MatrixXd(problem.unknowns.size(), 0));
  const SingularTriplets dense = problem.dense(4);
  ASSERT_LT(dense.values[1], 1e-13);
  const SingularTriplets free = problem.triplets({.count = 4, .multiple = true, .nearly_flat = 1, .krylov_from = 1});
  EXPECT_GT(free.inner_iterations, 0);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_LT(free.values[n], 1e-13) << n;
  for (std::size_t n = 2; n < 4; ++n) EXPECT_NEAR(free.values[n], dense.values[n], 1e-8 * dense.values[n]) << n;
}

TEST(LoopTriplets, GiveTheEigenpairsOfH) {
  const Problem problem(in_phase_at(8.3), "all");
  const loss::Linearization linearization(*problem.system, problem.loop, loss::Linearization::Order::jacobian);
  const auto h = problem.slice.reduce_symmetric(
      loss::assemble_hessian(linearization, problem.unknowns, loss::Curvature::gauss_newton));
  const Eigenpairs dense = smallest_eigenpairs(h, {.count = 2});
  const Eigenpairs free = smallest_eigenpairs(*problem.system, problem.loop, problem.unknowns, problem.slice,
                                              {.count = 2, .krylov_from = 1});
  for (int n = 0; n < 2; ++n) {
    const auto at = static_cast<std::size_t>(n);
    EXPECT_NEAR(free.values[at], dense.values[at], 1e-9 * dense.values[at]) << n;
    const Eigen::VectorXd v = free.vectors.col(n);
    EXPECT_NEAR(std::abs(problem.slice.reduce(v).dot(dense.vectors.col(n))), 1.0, 1e-9) << n;
    const Eigen::MatrixXd j = problem.jacobian();
    const double residual = problem.slice.reduce(2.0 * j.transpose() * (j * v) - free.values[at] * v).norm();
    EXPECT_NEAR(free.residuals[at], residual, 1e-10) << n;
    EXPECT_LT(residual, 1e-5 * free.values[at]) << n;
  }
}

TEST(LoopTriplets, SameBitsOnRepeat) {
  const Problem problem(in_phase_at(9.0), "all");
  const SingularTriplets first = problem.matrix_free(2);
  const SingularTriplets second = problem.matrix_free(2);
  EXPECT_EQ(first.values, second.values);
  EXPECT_TRUE(first.right == second.right);
  EXPECT_TRUE(first.left == second.left);
}

TEST(LoopTriplets, ManyAtOnce) {
  const Problem problem(in_phase_at(8.3), "all");
  const SingularTriplets dense = problem.dense(12);
  const SingularTriplets free = problem.matrix_free(12);
  for (std::size_t n = 0; n < 12; ++n) EXPECT_NEAR(free.values[n], dense.values[n], 1e-7 * dense.values[n]) << n;
}

TEST(LoopTriplets, SizeDecidesAndSystemsThatAreNotSquareStayDense) {
  const loop::Loop orbit = in_phase_at(8.3);
  const Problem small(orbit, "--");
  ASSERT_LT(small.unknowns.size(), TripletOptions{}.krylov_from);
  EXPECT_EQ(small.triplets({}).inner_iterations, 0);
  Problem whole(orbit, "all");
  ASSERT_GT(whole.unknowns.size(), TripletOptions{}.krylov_from);
  EXPECT_GT(whole.triplets({}).inner_iterations, 0);
  whole.slice = loss::Slice(whole.unknowns.size(), Eigen::MatrixXd(whole.unknowns.size(), 0));
  const SingularTriplets flat = whole.triplets({.count = 3, .krylov_from = 1});
  EXPECT_EQ(flat.inner_iterations, 0);
  EXPECT_LT(flat.values[1], 1e-9) << "the time shift and the family are flat";
  EXPECT_GT(flat.values[2], 1e-4);
}

TEST(LoopTriplets, RefuseWhatTheyCannotFind) {
  const loop::Loop orbit = in_phase_at(9.0);
  const Problem problem(orbit, "-+");
  EXPECT_THROW(static_cast<void>(problem.matrix_free(0)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(problem.matrix_free(problem.slice.free() + 1)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(problem.triplets({.count = 2, .nearly_flat = 2})), core::MisuseError);
  // Truncated, the loop is no orbit and its J not that of the equations.
  EXPECT_THROW(static_cast<void>(Problem(loop::with_cutoff(orbit, 13), "all").matrix_free(2)), core::NumericalError);
}

}  // namespace
}  // namespace orbweaver::spectrum::loop_triplets_test
