#include "orbweaver/equations/loop_equations.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "loss/cases.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/loop_solver.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/matrices.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::equations::loop_equations_test {
namespace {

using namespace loss;

/// Loop equations of a pendulum's loop (no orbit) over a sector of S@1/2 R@0, or over all modes; conditions as a
/// corrector or a spectrum has them.
struct Problem {
  Problem(const std::string& sector, int cutoff, double turns = 0.0)
      : loop(winding(test::linear_loop(test::in_phase(), 0.8, cutoff), turns)),
        unknowns{subspace(sector, cutoff), scalars(sector)},
        image(unknowns.subspace.image()),
        slice(unknowns.size(), conditions()),
        equations(*system, loop, unknowns, image, slice) {}

  [[nodiscard]] static loop::Loop winding(loop::Loop loop, double turns) {
    loop.winding[1] = turns;
    return loop;
  }
  [[nodiscard]] static std::vector<Scalar> scalars(const std::string& sector) {
    if (sector == "all" || sector == "++") return {Scalar::period()};
    return {};
  }
  [[nodiscard]] loop::Subspace subspace(const std::string& sector, int cutoff) const {
    if (sector == "all") return loop::Subspace::unrestricted(4, cutoff);
    const std::vector<int> signs{sector[0] == '+' ? 1 : -1, sector[1] == '+' ? 1 : -1};
    return {4, cutoff, test::pendulum_isotropy(*system), signs};
  }
  [[nodiscard]] Eigen::MatrixXd conditions() const {
    const Eigen::VectorXd shift = test::vector_of(unknowns.time_shift_direction(loop));
    Eigen::MatrixXd out(unknowns.size(), 0);
    if (unknowns.has_period()) out = test::unit_direction(unknowns.size(), 5);
    if (shift.norm() < 1e-8) return out;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols(1) = shift.normalized();
    return out;
  }
  /// The matrix of A, column by column.
  [[nodiscard]] Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd a(equations.size(), equations.size());
    for (int n = 0; n < equations.size(); ++n) equations.apply(Eigen::VectorXd::Unit(equations.size(), n), a.col(n));
    return a;
  }

  std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  loop::Loop loop;
  Unknowns unknowns;
  loop::Subspace image;
  Slice slice;
  LoopEquations equations;
};

class InSectors : public testing::TestWithParam<std::string> {};

/// Waves of the image over the rows of the Jacobian, which are nodal values over sqrt(N); doubled but for the mean,
/// they project.
Eigen::MatrixXd waves_of(const Problem& problem) {
  const Linearization& l = problem.equations.linearization();
  Eigen::MatrixXd waves(l.rows(), problem.image.size());
  for (int n = 0; n < problem.image.size(); ++n) {
    std::vector<double> modes(problem.loop.modes.size(), 0.0);
    problem.image.add_to(test::view(Eigen::VectorXd::Unit(problem.image.size(), n)), modes);
    l.grid().synthesize(l.cutoff(), l.dimension(), modes.data(), waves.col(n).data());
    waves.col(n) *= (problem.image.harmonic(n) == 0 ? 1.0 : 2.0) / std::sqrt(static_cast<double>(l.nodes()));
  }
  return waves;
}

TEST_P(InSectors, AreTheProjectedJacobianWithItsBorders) {
  const Problem problem(GetParam(), 7);
  const Eigen::MatrixXd j = test::to_dense(assemble_jacobian(problem.equations.linearization(), problem.unknowns));
  const int unfoldings = LoopEquations::unfoldings(problem.unknowns, problem.image, problem.slice);
  ASSERT_EQ(unfoldings, GetParam() == "all" || GetParam() == "+-" ? 1 : 0);
  const Linearization& l = problem.equations.linearization();
  const Eigen::MatrixXd waves = waves_of(problem);
  const Eigen::MatrixXd a = problem.matrix();
  const auto size = static_cast<Eigen::Index>(problem.unknowns.size());
  const Eigen::MatrixXd projected = waves.transpose() * j;
  EXPECT_LT((a.topLeftCorner(problem.image.size(), size) - projected).norm(), 1e-12 * projected.norm());
  const auto conditions = problem.slice.conditions().cols();
  EXPECT_EQ((a.bottomLeftCorner(conditions, size) - problem.slice.conditions().transpose()).norm(), 0.0);
  if (unfoldings == 1) {
    std::vector<double> state(4), gradient(4);
    Eigen::VectorXd nodal(l.rows());
    for (int node = 0; node < l.nodes(); ++node) {
      const double s = 2.0 * std::numbers::pi * node / l.nodes();
      state = loop::state_at(problem.loop, problem.loop.period * s / (2.0 * std::numbers::pi));
      problem.system->conserved_gradient(0, state, gradient);
      for (int i = 0; i < 4; ++i) nodal(i * l.nodes() + node) = gradient[static_cast<std::size_t>(i)];
    }
    nodal /= std::sqrt(static_cast<double>(l.nodes()));
    EXPECT_LT((a.col(size).head(problem.image.size()) + waves.transpose() * nodal).norm(), 1e-12 * nodal.norm());
  }
}

TEST_P(InSectors, TransposesAreTransposed) {
  Problem problem(GetParam(), 22);
  problem.equations.factor(*problem.system, problem.loop);
  const int size = problem.equations.size();
  const Eigen::VectorXd x = test::unit_direction(size, 1);
  const Eigen::VectorXd y = test::unit_direction(size, 2);
  Eigen::VectorXd ax(size), aty(size), mx(size), mty(size);
  problem.equations.apply(x, ax);
  problem.equations.apply_transposed(y, aty);
  EXPECT_NEAR(y.dot(ax), x.dot(aty), 1e-13 * ax.norm());
  problem.equations.precondition(x, mx);
  problem.equations.precondition_transposed(y, mty);
  EXPECT_NEAR(y.dot(mx), x.dot(mty), 1e-12 * mx.norm());
}

// A second-order scheme: the error goes with (2K + 1)^-2. (The column of T is right at orbits only: sectors without
// it.)
TEST(LoopEquations, TheBoxSchemeInvertsThemToSecondOrder) {
  for (const char* sector : {"+-", "-+", "--"}) {
    double error[2];
    const int cutoffs[2] = {22, 52};
    for (int n = 0; n < 2; ++n) {
      Problem problem(sector, cutoffs[n]);
      problem.equations.factor(*problem.system, problem.loop);
      Eigen::VectorXd b = Eigen::VectorXd::Zero(problem.equations.size());
      for (int m = 0; m < problem.image.size(); ++m) b(m) = std::exp(-problem.image.harmonic(m));
      Eigen::VectorXd x(b.size()), back(b.size());
      problem.equations.precondition(b, x);
      problem.equations.apply(x, back);
      error[n] = (back - b).norm() / b.norm();
    }
    EXPECT_LT(error[0], 0.1) << sector;
    EXPECT_NEAR(error[0] / error[1], std::pow(105.0 / 45.0, 2), 0.5) << sector;
  }
}

TEST_P(InSectors, SolvesAreThoseOfTheMatrix) {
  Problem problem(GetParam(), 10);
  problem.equations.factor(*problem.system, problem.loop);
  const Eigen::MatrixXd a = problem.matrix();
  LoopSolver solver(problem.equations.size(), "test_");
  const Eigen::VectorXd b = test::unit_direction(problem.equations.size(), 3);
  const Eigen::VectorXd x = solver.solve(problem.equations, b, {1e-12, 1e-11});
  const int once = solver.iterations();
  EXPECT_GT(once, 1);
  EXPECT_LT((a * x - b).norm(), 1e-11);
  const Eigen::VectorXd y = solver.solve_transposed(problem.equations, b, {1e-12, 1e-11});
  EXPECT_GT(solver.iterations(), once);
  EXPECT_LT((a.transpose() * y - b).norm(), 1e-11);
}

TEST_P(InSectors, RaisedSolvesAreThoseOfTheMatrixWithTheOuterProduct) {
  Problem problem(GetParam(), 10);
  problem.equations.factor(*problem.system, problem.loop);
  const int size = problem.equations.size();
  Eigen::MatrixXd columns(size, 2);
  Eigen::MatrixXd rows(size, 2);
  for (int n = 0; n < 2; ++n) {
    columns.col(n) = test::unit_direction(size, 5 + n);
    rows.col(n) = test::unit_direction(size, 7 + n);
  }
  const Eigen::MatrixXd plain = problem.matrix();
  const Eigen::MatrixXd raised = plain + columns * rows.transpose();
  LoopSolver solver(size, "test_");
  const Eigen::VectorXd b = test::unit_direction(size, 3);
  solver.raise({columns, rows});
  EXPECT_LT((raised * solver.solve(problem.equations, b, {1e-12, 1e-11}) - b).norm(), 1e-11);
  EXPECT_LT((raised.transpose() * solver.solve_transposed(problem.equations, b, {1e-12, 1e-11}) - b).norm(), 1e-11);
  solver.raise({});
  EXPECT_LT((plain * solver.solve(problem.equations, b, {1e-12, 1e-11}) - b).norm(), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(LoopEquations, InSectors, testing::Values("all", "++", "+-", "-+", "--"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name) c = c == '+' ? 'p' : c == '-' ? 'm' : c;
                           return name;
                         });

TEST(LoopEquations, OfALoopThatWindsAreTheProjectedJacobian) {
  const Problem problem("all", 7, -2.0);
  const Eigen::MatrixXd j = test::to_dense(assemble_jacobian(problem.equations.linearization(), problem.unknowns));
  const Eigen::MatrixXd projected = waves_of(problem).transpose() * j;
  const Eigen::MatrixXd a = problem.matrix();
  EXPECT_LT((a.topLeftCorner(projected.rows(), projected.cols()) - projected).norm(), 1e-12 * projected.norm());
}

TEST(LoopEquations, NeedAsManyConditionsAsScalars) {
  const Problem all("all", 4);
  const Slice none(all.unknowns.size(), Eigen::MatrixXd(all.unknowns.size(), 0));
  EXPECT_THROW(LoopEquations(*all.system, all.loop, all.unknowns, all.image, none), core::MisuseError);
}

TEST(LoopEquations, AreSquareWithAnUnfoldingOnlyWhereEnergyIsConserved) {
  const Problem all("all", 4);
  EXPECT_TRUE(LoopEquations::are_square(*all.system, all.unknowns, all.image, all.slice));
  const Slice tangent_only(all.unknowns.size(), all.conditions().leftCols(1));
  EXPECT_TRUE(LoopEquations::are_square(*all.system, all.unknowns, all.image, tangent_only));
  const Slice none(all.unknowns.size(), Eigen::MatrixXd(all.unknowns.size(), 0));
  EXPECT_FALSE(LoopEquations::are_square(*all.system, all.unknowns, all.image, none));
}

}  // namespace
}  // namespace orbweaver::equations::loop_equations_test
