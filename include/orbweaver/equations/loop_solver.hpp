#pragma once

#include <memory>

#include <Eigen/Dense>

#include "orbweaver/equations/loop_equations.hpp"

namespace orbweaver::equations {

/// GMRES on loop equations of one size, preconditioned from the right by their box scheme (which must be factored).
/// Overridable under an options prefix. With equations of a team, solves are collective over it: each member iterates
/// by itself on the same numbers, and what they exchange is the equations' alone (core::Team).
class LoopSolver {
 public:
  /// Residuals relative to the right side: asked for, and still accepted where rounding stops GMRES earlier. Beside a
  /// kernel at rounding the solution is so large that its own rounding exceeds the right side: a residual is accepted
  /// as well that is no more than `of_solution` (a rate) times the solution, which inverse iterations ask for.
  struct Accuracy {
    double wanted = 1e-8;
    double accepted = 1e-5;
    double of_solution = 0.0;
  };

  /// columns rows' of size x count each.
  struct Outer {
    Eigen::MatrixXd columns;
    Eigen::MatrixXd rows;
  };

  LoopSolver(int size, const char* options_prefix);
  ~LoopSolver();
  LoopSolver(const LoopSolver&) = delete;
  LoopSolver& operator=(const LoopSolver&) = delete;
  LoopSolver(LoopSolver&&) = delete;
  LoopSolver& operator=(LoopSolver&&) = delete;

  /// From here on A + columns rows' stands for A; the preconditioner remains. Empty: A itself.
  void raise(Outer outer);

  /// A x = right side. Throws NumericalError unless the residual falls to what is accepted.
  [[nodiscard]] Eigen::VectorXd solve(const LoopEquations& equations, const Eigen::VectorXd& right_side,
                                      Accuracy accuracy);
  /// A' x = right side.
  [[nodiscard]] Eigen::VectorXd solve_transposed(const LoopEquations& equations, const Eigen::VectorXd& right_side,
                                                 Accuracy accuracy);

  /// GMRES iterations of all solves so far.
  [[nodiscard]] int iterations() const { return _iterations; }

 private:
  struct Krylov;
  Eigen::VectorXd run(const LoopEquations& equations, const Eigen::VectorXd& right_side, Accuracy accuracy,
                      bool transposed);
  std::unique_ptr<Krylov> _krylov;
  int _iterations = 0;
};

}  // namespace orbweaver::equations
