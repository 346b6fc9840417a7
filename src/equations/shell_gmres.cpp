#include "shell_gmres.hpp"

#include <algorithm>
#include <utility>

#include <petscksp.h>

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
  ShellGmres::Actions actions;
  core::CallbackGuard guard{};
};

using Member = ShellGmres::Action ShellGmres::Actions::*;

PetscErrorCode apply(Context& context, Member action, Vec x, Vec y) {
  PetscInt rows = 0;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(VecGetLocalSize(x, &rows));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  const PetscErrorCode code = context.guard.run(
      [&] { (context.actions.*action)(loss::ConstVectorMap(in, rows), loss::VectorMap(out, rows)); });
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  return code;
}

template <Member action>
PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(MatShellGetContext(matrix, &context));
  return apply(*static_cast<Context*>(context), action, x, y);
}

template <Member action>
PetscErrorCode run_preconditioner(PC pc, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(PCShellGetContext(pc, &context));
  return apply(*static_cast<Context*>(context), action, x, y);
}

}  // namespace

struct ShellGmres::Solver {
  Context context;
  core::Handle<Vec> right_side;
  core::Handle<Vec> solution;
  core::Handle<Mat> matrix;
  core::Handle<KSP> ksp;
};

ShellGmres::ShellGmres(int size, const char* options_prefix, Actions actions) : _solver(std::make_unique<Solver>()) {
  Solver& s = *_solver;
  s.context.actions = std::move(actions);
  core::check(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &s.context, s.matrix.put()), "MatCreateShell");
  core::check(MatCreateVecs(s.matrix.get(), s.solution.put(), s.right_side.put()), "MatCreateVecs");
  const auto set = [&](MatOperation operation, PetscErrorCode (*function)(Mat, Vec, Vec)) {
    core::check(MatShellSetOperation(s.matrix.get(), operation, reinterpret_cast<void (*)()>(function)),
                "MatShellSetOperation");
  };
  set(MATOP_MULT, multiply<&Actions::multiply>);
  set(MATOP_MULT_TRANSPOSE, multiply<&Actions::multiply_transposed>);
  core::check(KSPCreate(PETSC_COMM_SELF, s.ksp.put()), "KSPCreate");
  core::check(KSPSetOptionsPrefix(s.ksp.get(), options_prefix), "KSPSetOptionsPrefix");
  core::check(KSPSetOperators(s.ksp.get(), s.matrix.get(), s.matrix.get()), "KSPSetOperators");
  core::check(KSPSetType(s.ksp.get(), KSPGMRES), "KSPSetType");
  core::check(KSPGMRESSetRestart(s.ksp.get(), restart), "KSPGMRESSetRestart");
  core::check(KSPSetPCSide(s.ksp.get(), PC_RIGHT), "KSPSetPCSide");
  PC pc = nullptr;
  core::check(KSPGetPC(s.ksp.get(), &pc), "KSPGetPC");
  core::check(PCSetType(pc, PCSHELL), "PCSetType");
  core::check(PCShellSetContext(pc, &s.context), "PCShellSetContext");
  core::check(PCShellSetApply(pc, run_preconditioner<&Actions::precondition>), "PCShellSetApply");
  core::check(PCShellSetApplyTranspose(pc, run_preconditioner<&Actions::precondition_transposed>),
              "PCShellSetApplyTranspose");
  core::check(KSPSetFromOptions(s.ksp.get()), "KSPSetFromOptions");
}

ShellGmres::~ShellGmres() = default;

ShellGmres::Result ShellGmres::solve(const Eigen::VectorXd& right_side, Accuracy accuracy, bool transposed) {
  Solver& s = *_solver;
  loss::assign(s.right_side.get(), right_side);
  core::check(KSPSetTolerances(s.ksp.get(), accuracy.relative, std::max(accuracy.absolute, zero), PETSC_DEFAULT,
                               most_iterations),
              "KSPSetTolerances");
  const PetscErrorCode code = transposed ? KSPSolveTranspose(s.ksp.get(), s.right_side.get(), s.solution.get())
                                         : KSPSolve(s.ksp.get(), s.right_side.get(), s.solution.get());
  s.context.guard.rethrow();
  core::check(code, "KSPSolve");
  PetscInt iterations = 0;
  Result result;
  core::check(KSPGetIterationNumber(s.ksp.get(), &iterations), "KSPGetIterationNumber");
  core::check(KSPGetResidualNorm(s.ksp.get(), &result.residual), "KSPGetResidualNorm");
  result.iterations = static_cast<int>(iterations);
  result.x = loss::to_eigen(s.solution.get());
  return result;
}

}  // namespace orbweaver::equations
