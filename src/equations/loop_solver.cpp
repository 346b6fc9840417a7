#include "orbweaver/equations/loop_solver.hpp"

#include <petscksp.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/callback.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::equations {

namespace {

// Two or three iterations are the rule (docs/performance.md); next to singular points a few dozen.
constexpr int restart = 60;
constexpr int most_iterations = 180;
/// Absolute: a right side of zeros has the solution zero.
constexpr double zero = 1e-300;

struct Context {
  const LoopEquations* equations = nullptr;
  LoopSolver::Outer raised{};
  core::CallbackGuard guard{};
};

using Product = void (*)(const Context&, const LoopEquations::In&, LoopEquations::Out);

void apply_raised(const Context& context, const LoopEquations::In& x, LoopEquations::Out out) {
  context.equations->apply(x, out);
  if (context.raised.columns.size() > 0) out += context.raised.columns * (context.raised.rows.transpose() * x);
}

void apply_raised_transposed(const Context& context, const LoopEquations::In& y, LoopEquations::Out out) {
  context.equations->apply_transposed(y, out);
  if (context.raised.columns.size() > 0) out += context.raised.rows * (context.raised.columns.transpose() * y);
}

void precondition(const Context& context, const LoopEquations::In& r, LoopEquations::Out out) {
  context.equations->precondition(r, out);
}

void precondition_transposed(const Context& context, const LoopEquations::In& u, LoopEquations::Out out) {
  context.equations->precondition_transposed(u, out);
}

PetscErrorCode apply(Context& context, Product product, Vec x, Vec y) {
  PetscInt rows = 0;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(VecGetLocalSize(x, &rows));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  const PetscErrorCode code =
      context.guard.run([&] { product(context, loss::ConstVectorMap(in, rows), loss::VectorMap(out, rows)); });
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  return code;
}

template <Product product>
PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(MatShellGetContext(matrix, &context));
  return apply(*static_cast<Context*>(context), product, x, y);
}

template <Product product>
PetscErrorCode run_preconditioner(PC pc, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(PCShellGetContext(pc, &context));
  return apply(*static_cast<Context*>(context), product, x, y);
}

}  // namespace

struct LoopSolver::Krylov {
  Context context;
  core::Handle<Vec> right_side;
  core::Handle<Vec> solution;
  core::Handle<Mat> matrix;
  core::Handle<KSP> ksp;
};

LoopSolver::LoopSolver(int size, const char* options_prefix) : _krylov(std::make_unique<Krylov>()) {
  Krylov& k = *_krylov;
  core::check(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &k.context, k.matrix.put()), "MatCreateShell");
  core::check(MatCreateVecs(k.matrix.get(), k.solution.put(), k.right_side.put()), "MatCreateVecs");
  const auto set = [&](MatOperation operation, PetscErrorCode (*function)(Mat, Vec, Vec)) {
    core::check(MatShellSetOperation(k.matrix.get(), operation, reinterpret_cast<void (*)()>(function)),
                "MatShellSetOperation");
  };
  set(MATOP_MULT, multiply<apply_raised>);
  set(MATOP_MULT_TRANSPOSE, multiply<apply_raised_transposed>);
  core::check(KSPCreate(PETSC_COMM_SELF, k.ksp.put()), "KSPCreate");
  core::check(KSPSetOptionsPrefix(k.ksp.get(), options_prefix), "KSPSetOptionsPrefix");
  core::check(KSPSetOperators(k.ksp.get(), k.matrix.get(), k.matrix.get()), "KSPSetOperators");
  core::check(KSPSetType(k.ksp.get(), KSPGMRES), "KSPSetType");
  core::check(KSPGMRESSetRestart(k.ksp.get(), restart), "KSPGMRESSetRestart");
  core::check(KSPSetPCSide(k.ksp.get(), PC_RIGHT), "KSPSetPCSide");
  PC pc = nullptr;
  core::check(KSPGetPC(k.ksp.get(), &pc), "KSPGetPC");
  core::check(PCSetType(pc, PCSHELL), "PCSetType");
  core::check(PCShellSetContext(pc, &k.context), "PCShellSetContext");
  core::check(PCShellSetApply(pc, run_preconditioner<precondition>), "PCShellSetApply");
  core::check(PCShellSetApplyTranspose(pc, run_preconditioner<precondition_transposed>), "PCShellSetApplyTranspose");
  core::check(KSPSetFromOptions(k.ksp.get()), "KSPSetFromOptions");
}

LoopSolver::~LoopSolver() = default;

void LoopSolver::raise(Outer outer) { _krylov->context.raised = std::move(outer); }

Eigen::VectorXd LoopSolver::run(const LoopEquations& equations, const Eigen::VectorXd& right_side, Accuracy accuracy,
                                bool transposed) {
  Krylov& k = *_krylov;
  k.context.equations = &equations;
  loss::assign(k.right_side.get(), right_side);
  core::check(KSPSetTolerances(k.ksp.get(), accuracy.wanted, zero, PETSC_DEFAULT, most_iterations), "KSPSetTolerances");
  const PetscErrorCode code = transposed ? KSPSolveTranspose(k.ksp.get(), k.right_side.get(), k.solution.get())
                                         : KSPSolve(k.ksp.get(), k.right_side.get(), k.solution.get());
  k.context.guard.rethrow();
  core::check(code, "KSPSolve");
  PetscInt iterations = 0;
  double residual = 0.0;
  core::check(KSPGetIterationNumber(k.ksp.get(), &iterations), "KSPGetIterationNumber");
  core::check(KSPGetResidualNorm(k.ksp.get(), &residual), "KSPGetResidualNorm");
  _iterations += static_cast<int>(iterations);
  Eigen::VectorXd x = loss::to_eigen(k.solution.get());
  const double accepted = accuracy.accepted * right_side.norm() + accuracy.of_solution * x.norm() + zero;
  if (!x.allFinite() || !(residual <= accepted))
    throw core::NumericalError(
        "GMRES on the loop equations does not converge: the orbit is near a point where they are singular");
  return x;
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
