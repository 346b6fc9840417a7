#include "orbweaver/equations/loop_solver.hpp"

#include <utility>

#include "orbweaver/core/error.hpp"
#include "shell_gmres.hpp"

namespace orbweaver::equations {

namespace {

/// Still accepted where the right side is zero.
constexpr double nothing = 1e-300;

}  // namespace

struct LoopSolver::Krylov {
  const LoopEquations* equations = nullptr;
  Outer raised{};
  ShellGmres gmres;

  Krylov(int size, const char* options_prefix)
      : gmres(size, options_prefix,
              {[this](const LoopEquations::In& x, LoopEquations::Out out) {
                 equations->apply(x, out);
                 if (raised.columns.size() > 0) out += raised.columns * (raised.rows.transpose() * x);
               },
               [this](const LoopEquations::In& r, LoopEquations::Out out) { equations->precondition(r, out); },
               [this](const LoopEquations::In& y, LoopEquations::Out out) {
                 equations->apply_transposed(y, out);
                 if (raised.columns.size() > 0) out += raised.rows * (raised.columns.transpose() * y);
               },
               [this](const LoopEquations::In& u, LoopEquations::Out out) {
                 equations->precondition_transposed(u, out);
               }}) {}
};

LoopSolver::LoopSolver(int size, const char* options_prefix)
    : _krylov(std::make_unique<Krylov>(size, options_prefix)) {}

LoopSolver::~LoopSolver() = default;

void LoopSolver::raise(Outer outer) { _krylov->raised = std::move(outer); }

Eigen::VectorXd LoopSolver::run(const LoopEquations& equations, const Eigen::VectorXd& right_side, Accuracy accuracy,
                                bool transposed) {
  _krylov->equations = &equations;
  ShellGmres::Result result = _krylov->gmres.solve(right_side, {.relative = accuracy.wanted}, transposed);
  _iterations += result.iterations;
  const double accepted = accuracy.accepted * right_side.norm() + accuracy.of_solution * result.x.norm() + nothing;
  if (!result.x.allFinite() || !(result.residual <= accepted))
    throw core::NumericalError(
        "GMRES on the loop equations does not converge: the orbit is near a point where they are singular");
  return std::move(result.x);
}

Eigen::VectorXd LoopSolver::solve(const LoopEquations& equations, const Eigen::VectorXd& right_side,
                                  Accuracy accuracy) {
  return run(equations, right_side, accuracy, false);
}

Eigen::VectorXd LoopSolver::solve_transposed(const LoopEquations& equations, const Eigen::VectorXd& right_side,
                                             Accuracy accuracy) {
  return run(equations, right_side, accuracy, true);
}

}  // namespace orbweaver::equations
