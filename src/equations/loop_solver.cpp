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
  core::Team* team = nullptr;
  core::CallbackGuard guard{};
};

using Product = void (LoopEquations::*)(const LoopEquations::In&, LoopEquations::Out) const;

// This rank's rows of a vector, as they are distributed over the team.
core::Team::Part rows_of(const core::Team* team, int size) {
  return team == nullptr ? core::Team::Part{0, size} : team->part_of(team->rank(), size);
}

// A vector of which PETSc has this rank's rows, whole.
Eigen::VectorXd whole(core::Team* team, const loss::ConstVectorMap& rows, int size) {
  if (team == nullptr) return rows;
  Eigen::VectorXd all(size);
  team->divide("loop solver: a vector", size, 1, all.data(),
               [&](int begin, int end) { all.segment(begin, end - begin) = rows; });
  return all;
}

void apply_with_team(Context& context, Product product, const loss::ConstVectorMap& in, loss::VectorMap out) {
  // A member that fails alone within must not leave the others in PETSc's own collectives.
  context.team->together("loop solver: a product", [&] {
    const int size = context.equations->size();
    const Eigen::VectorXd x = whole(context.team, in, size);
    Eigen::VectorXd y(size);
    (context.equations->*product)(x, y);
    out = y.segment(rows_of(context.team, size).begin, out.size());
  });
}

PetscErrorCode apply(Context& context, Product product, Vec x, Vec y) {
  PetscInt rows = 0;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(VecGetLocalSize(x, &rows));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  const PetscErrorCode code = context.guard.run([&] {
    if (context.team != nullptr)
      apply_with_team(context, product, loss::ConstVectorMap(in, rows), loss::VectorMap(out, rows));
    else
      (context.equations->*product)(loss::ConstVectorMap(in, rows), loss::VectorMap(out, rows));
  });
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

LoopSolver::LoopSolver(int size, const char* options_prefix, core::Team* team) : _krylov(std::make_unique<Krylov>()) {
  Krylov& k = *_krylov;
  k.context.team = core::several(team);
  const MPI_Comm comm = k.context.team != nullptr ? k.context.team->comm() : PETSC_COMM_SELF;
  const core::Team::Part mine = rows_of(k.context.team, size);
  const int rows = mine.end - mine.begin;
  core::check(MatCreateShell(comm, rows, rows, size, size, &k.context, k.matrix.put()), "MatCreateShell");
  core::check(MatCreateVecs(k.matrix.get(), k.solution.put(), k.right_side.put()), "MatCreateVecs");
  const auto set = [&](MatOperation operation, PetscErrorCode (*function)(Mat, Vec, Vec)) {
    core::check(MatShellSetOperation(k.matrix.get(), operation, reinterpret_cast<void (*)()>(function)),
                "MatShellSetOperation");
  };
  set(MATOP_MULT, multiply<&LoopEquations::apply>);
  set(MATOP_MULT_TRANSPOSE, multiply<&LoopEquations::apply_transposed>);
  core::check(KSPCreate(comm, k.ksp.put()), "KSPCreate");
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
  core::Team* const team = k.context.team;
  const int size = static_cast<int>(right_side.size());
  core::require(equations.team() == team, "loop equations and their solver need the same team");
  k.context.equations = &equations;
  const core::Team::Part mine = rows_of(team, size);
  loss::assign(k.right_side.get(), right_side.segment(mine.begin, mine.end - mine.begin));
  if (team != nullptr) team->compare("loop solver: a solve", static_cast<std::uint64_t>(size));
  core::check(KSPSetTolerances(k.ksp.get(), accuracy.wanted, zero, PETSC_DEFAULT, most_iterations), "KSPSetTolerances");
  const PetscErrorCode code = transposed ? KSPSolveTranspose(k.ksp.get(), k.right_side.get(), k.solution.get())
                                         : KSPSolve(k.ksp.get(), k.right_side.get(), k.solution.get());
  k.context.guard.rethrow();
  core::check(code, "KSPSolve");
  PetscInt iterations = 0;
  double residual = 0.0;
  core::check(KSPGetIterationNumber(k.ksp.get(), &iterations), "KSPGetIterationNumber");
  core::check(KSPGetResidualNorm(k.ksp.get(), &residual), "KSPGetResidualNorm");
  // What is decided below rests on one member's word: sums over ranks may differ in their last bits.
  if (team != nullptr) team->divide("loop solver: the residual", 1, 1, &residual, [](int, int) {});
  _iterations += static_cast<int>(iterations);
  const Eigen::VectorXd own = loss::to_eigen(k.solution.get());
  Eigen::VectorXd x = whole(team, loss::ConstVectorMap(own.data(), own.size()), size);
  if (!x.allFinite() || !(residual <= accuracy.accepted * right_side.norm() + zero))
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
