#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "box_problem.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/equations/loop_solver.hpp"
#include "support/oscillator_chain.hpp"

namespace orbweaver::equations::team_test {
namespace {

using namespace loss;

/// Loop equations of a chain's loop (no orbit) over all modes, two conditions, a free period and an unfolding.
struct Problem {
  explicit Problem(core::Team* team)
      : loop(loop_of(chain)),
        unknowns{loop::Subspace::unrestricted(chain.dimension(), loop.cutoff), {Scalar::period()}},
        image(unknowns.subspace.image()),
        slice(unknowns.size(), conditions()),
        equations(chain, loop, unknowns, image, slice, team) {}

  static loop::Loop loop_of(const test::OscillatorChain& chain) {
    loop::Loop loop =
        loop::constant_loop(std::vector<double>(static_cast<std::size_t>(chain.dimension()), 0.0), 6.0, 8);
    for (std::size_t n = 0; n < loop.modes.size(); ++n)
      loop.modes[n] = std::sin(1.0 + 3.0 * static_cast<double>(n)) / (1.0 + static_cast<double>(n / 16));
    return loop;
  }
  [[nodiscard]] Eigen::MatrixXd conditions() const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(unknowns.size(), 2);
    const std::vector<double> shift = unknowns.time_shift_direction(loop);
    out.col(0) = Eigen::VectorXd::Unit(unknowns.size(), 20);
    out.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size()).normalized();
    return out;
  }
  [[nodiscard]] Eigen::VectorXd vector(double phase) const {
    Eigen::VectorXd v(equations.size());
    for (Eigen::Index n = 0; n < v.size(); ++n) v(n) = std::cos(phase + 2.0 * static_cast<double>(n));
    return v;
  }

  test::OscillatorChain chain{8};
  loop::Loop loop;
  Unknowns unknowns;
  loop::Subspace image;
  Slice slice;
  LoopEquations equations;
};

class WithTeam : public testing::Test {
 protected:
  WithTeam() {
    alone.equations.factor(alone.chain, alone.loop);
    shared.equations.factor(shared.chain, shared.loop);
  }
  core::Team team{MPI_COMM_WORLD};
  Problem alone{nullptr};
  Problem shared{&team};
  LoopSolver::Accuracy accuracy{1e-11, 1e-9};
};

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).norm() / b.norm(); }

TEST_F(WithTeam, ThePreconditionerIsTheSameInverse) {
  const Eigen::VectorXd right = alone.vector(0.3);
  Eigen::VectorXd expected(right.size());
  Eigen::VectorXd found(right.size());
  alone.equations.precondition(right, expected);
  shared.equations.precondition(right, found);
  EXPECT_LT(difference(found, expected), 1e-12);
  alone.equations.precondition_transposed(right, expected);
  shared.equations.precondition_transposed(right, found);
  EXPECT_LT(difference(found, expected), 1e-12);
}

TEST_F(WithTeam, EliminatesAStretchAMember) {
  for (const bool closed : {false, true})
    for (const int dimension : {1, 3, 4, 5, 8})
      for (const int cells : {2, 7, 24})
        for (const int borders : {1, 2, 5}) {
          const test::BoxProblem problem({dimension, cells, borders, closed});
          const auto box = BoxScheme::of_dimension(dimension, BoxScheme::Storage::line);
          problem.factor(*box, &team);
          for (const bool transposed : {false, true})
            EXPECT_LT(problem.residual(*box, transposed), 1e-14) << dimension << ' ' << cells << ' ' << borders;
        }
  // With lanes every member has four stretches of its own.
  const test::BoxProblem problem({4, 24, 2});
  const auto box = BoxScheme::of_dimension(4, BoxScheme::Storage::lanes);
  problem.factor(*box, &team);
  for (const bool transposed : {false, true}) EXPECT_LT(problem.residual(*box, transposed), 1e-14);
}

TEST_F(WithTeam, SolvesGiveTheSolution) {
  LoopSolver by_one(alone.equations.size(), "alone_");
  LoopSolver by_all(shared.equations.size(), "shared_");
  const Eigen::VectorXd right = alone.vector(0.7);
  const Eigen::VectorXd x = by_all.solve(shared.equations, right, accuracy);
  EXPECT_LT(difference(x, by_one.solve(alone.equations, right, accuracy)), 1e-8);
  Eigen::VectorXd back(right.size());
  alone.equations.apply(x, back);
  EXPECT_LT(difference(back, right), 1e-9);
  const Eigen::VectorXd y = by_all.solve_transposed(shared.equations, right, accuracy);
  alone.equations.apply_transposed(y, back);
  EXPECT_LT(difference(back, right), 1e-9);
}

TEST_F(WithTeam, MembersHaveTheSameBits) {
  LoopSolver solver(shared.equations.size(), "shared_");
  const Eigen::VectorXd x = solver.solve(shared.equations, shared.vector(0.1), accuracy);
  team.compare("solutions", core::digest_of({reinterpret_cast<const char*>(x.data()), sizeof(double) * x.size()}));
  const Eigen::VectorXd again = solver.solve(shared.equations, shared.vector(0.1), accuracy);
  EXPECT_EQ(x, again);
}

}  // namespace
}  // namespace orbweaver::equations::team_test
