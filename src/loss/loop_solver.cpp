#include "orbweaver/loss/loop_solver.hpp"

#include <petscksp.h>

#include "orbweaver/core/callback.hpp"
#include "orbweaver/core/check.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/handle.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss {

namespace {

constexpr int restart = 60;
constexpr int most_iterations = 180;

struct Context {
  const LoopEquations* equations = nullptr;
  core::CallbackGuard guard{};
};

using Product = void (LoopEquations::*)(const LoopEquations::In&, LoopEquations::Out) const;

PetscErrorCode apply(Context& context, Product product, Vec x, Vec y) {
  PetscInt size = 0;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(VecGetLocalSize(x, &size));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  const PetscErrorCode code =
      context.guard.run([&] { (context.equations->*product)(ConstVectorMap(in, size), VectorMap(out, size)); });
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
PetscErrorCode precondition(PC pc, Vec x, Vec y) {
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
  k.right_side = create_vector(size);
  k.solution = create_vector(size);
  core::check(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &k.context, k.matrix.put()), "MatCreateShell");
  const auto set = [&](MatOperation operation, PetscErrorCode (*function)(Mat, Vec, Vec)) {
    core::check(MatShellSetOperation(k.matrix.get(), operation, reinterpret_cast<void (*)()>(function)),
                "MatShellSetOperation");
  };
  set(MATOP_MULT, multiply<&LoopEquations::apply>);
  set(MATOP_MULT_TRANSPOSE, multiply<&LoopEquations::apply_transposed>);
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
  core::check(PCShellSetApply(pc, precondition<&LoopEquations::precondition>), "PCShellSetApply");
  core::check(PCShellSetApplyTranspose(pc, precondition<&LoopEquations::precondition_transposed>),
              "PCShellSetApplyTranspose");
  core::check(KSPSetFromOptions(k.ksp.get()), "KSPSetFromOptions");
}

LoopSolver::~LoopSolver() = default;

Eigen::VectorXd LoopSolver::run(const LoopEquations& equations, const Eigen::VectorXd& right_side, Accuracy accuracy,
                                bool transposed) {
  Krylov& k = *_krylov;
  k.context.equations = &equations;
  assign(k.right_side.get(), right_side);
  core::check(KSPSetTolerances(k.ksp.get(), accuracy.wanted, 1e-300, PETSC_DEFAULT, most_iterations),
              "KSPSetTolerances");
  const PetscErrorCode code = transposed ? KSPSolveTranspose(k.ksp.get(), k.right_side.get(), k.solution.get())
                                         : KSPSolve(k.ksp.get(), k.right_side.get(), k.solution.get());
  k.context.guard.rethrow();
  core::check(code, "KSPSolve");
  PetscInt iterations = 0;
  PetscReal residual = 0.0;
  core::check(KSPGetIterationNumber(k.ksp.get(), &iterations), "KSPGetIterationNumber");
  core::check(KSPGetResidualNorm(k.ksp.get(), &residual), "KSPGetResidualNorm");
  _iterations += static_cast<int>(iterations);
  Eigen::VectorXd x = to_eigen(k.solution.get());
  if (!x.allFinite() || !(residual <= accuracy.accepted * right_side.norm() + 1e-300))
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

}  // namespace orbweaver::loss
