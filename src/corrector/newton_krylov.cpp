#include "newton_krylov.hpp"

#include <cmath>
#include <limits>

#include <petscksp.h>

#include "orbweaver/core/callback.hpp"
#include "orbweaver/core/check.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/dense.hpp"
#include "orbweaver/loss/loop_equations.hpp"

namespace orbweaver::corrector {

namespace {

constexpr int restart = 60;
constexpr int most_inner = 180;
// Relative residuals: asked for, and still accepted where rounding stops GMRES earlier.
struct Accuracy {
  double wanted;
  double accepted;
};
constexpr Accuracy of_steps{1e-8, 1e-5};  // a step's error is squared away by the next
constexpr Accuracy of_flat_direction{1e-13, 1e-8};

struct Context {
  const loss::LoopEquations* equations = nullptr;
  core::CallbackGuard guard{};
};

PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  void* raw = nullptr;
  PetscCall(MatShellGetContext(matrix, &raw));
  auto& c = *static_cast<Context*>(raw);
  return c.guard.run([&] { loss::assign(y, c.equations->apply(loss::to_eigen(x))); });
}

PetscErrorCode precondition(PC pc, Vec x, Vec y) {
  void* raw = nullptr;
  PetscCall(PCShellGetContext(pc, &raw));
  auto& c = *static_cast<Context*>(raw);
  return c.guard.run([&] { loss::assign(y, c.equations->precondition(loss::to_eigen(x))); });
}

// GMRES on the equations of one Newton step, made once for a size.
class InnerSolver {
 public:
  explicit InnerSolver(int size) : _right_side(loss::create_vector(size)), _solution(loss::create_vector(size)) {
    core::check(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &_context, _matrix.put()), "MatCreateShell");
    core::check(MatShellSetOperation(_matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)),
                "MatShellSetOperation");
    core::check(KSPCreate(PETSC_COMM_SELF, _ksp.put()), "KSPCreate");
    core::check(KSPSetOptionsPrefix(_ksp.get(), "corrector_inner_"), "KSPSetOptionsPrefix");
    core::check(KSPSetOperators(_ksp.get(), _matrix.get(), _matrix.get()), "KSPSetOperators");
    core::check(KSPSetType(_ksp.get(), KSPGMRES), "KSPSetType");
    core::check(KSPGMRESSetRestart(_ksp.get(), restart), "KSPGMRESSetRestart");
    core::check(KSPSetPCSide(_ksp.get(), PC_RIGHT), "KSPSetPCSide");
    PC pc = nullptr;
    core::check(KSPGetPC(_ksp.get(), &pc), "KSPGetPC");
    core::check(PCSetType(pc, PCSHELL), "PCSetType");
    core::check(PCShellSetContext(pc, &_context), "PCShellSetContext");
    core::check(PCShellSetApply(pc, precondition), "PCShellSetApply");
    core::check(KSPSetFromOptions(_ksp.get()), "KSPSetFromOptions");
  }

  /// Throws NumericalError unless the residual falls to what is accepted.
  Eigen::VectorXd solve(const loss::LoopEquations& equations, const Eigen::VectorXd& right_side, Accuracy accuracy) {
    _context.equations = &equations;
    loss::assign(_right_side.get(), right_side);
    core::check(KSPSetTolerances(_ksp.get(), accuracy.wanted, 1e-300, PETSC_DEFAULT, most_inner), "KSPSetTolerances");
    const PetscErrorCode code = KSPSolve(_ksp.get(), _right_side.get(), _solution.get());
    _context.guard.rethrow();
    core::check(code, "KSPSolve");
    PetscInt iterations = 0;
    PetscReal residual = 0.0;
    core::check(KSPGetIterationNumber(_ksp.get(), &iterations), "KSPGetIterationNumber");
    core::check(KSPGetResidualNorm(_ksp.get(), &residual), "KSPGetResidualNorm");
    _iterations += static_cast<int>(iterations);
    Eigen::VectorXd x = loss::to_eigen(_solution.get());
    if (!x.allFinite() || !(residual <= accuracy.accepted * right_side.norm() + 1e-300))
      throw core::NumericalError(
          "GMRES on the loop equations does not converge: the orbit is near a point where they are singular");
    return x;
  }

  [[nodiscard]] int iterations() const { return _iterations; }

 private:
  Context _context;
  core::Handle<Vec> _right_side;
  core::Handle<Vec> _solution;
  core::Handle<Mat> _matrix;
  core::Handle<KSP> _ksp;
  int _iterations = 0;
};

}  // namespace

bool newton_krylov_applies(const systems::System& system, const loss::Unknowns& unknowns, const loss::Slice& slice) {
  if (!unknowns.period || slice.conditions().cols() < 1) return false;
  const int unfoldings = loss::LoopEquations::unfoldings(unknowns, unknowns.subspace.image(), slice);
  const bool square_without = unfoldings == 0 && slice.conditions().cols() == 1;
  const bool square_with = unfoldings == 1 && slice.conditions().cols() == 2 && system.description().conservative;
  return square_without || square_with;
}

NewtonKrylovRun run_newton_krylov(const systems::System& system, const loop::Loop& guess,
                                  const loss::Unknowns& unknowns, const loss::Slice& slice, const Options& options,
                                  bool want_flat_direction) {
  const loop::Subspace image = unknowns.subspace.image();
  const int most = options.max_iterations > 0 ? options.max_iterations : 30;
  NewtonKrylovRun run;
  run.loop = guess;
  InnerSolver inner(unknowns.size() + loss::LoopEquations::unfoldings(unknowns, image, slice));
  double last_loss = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  while (run.stop == Stop::none) {
    loss::LoopEquations equations(system, run.loop, unknowns, image, slice);
    const double threshold = acceptance_threshold(run.loop, equations.linearization(), options.tolerance);
    without_progress = equations.loss() < 0.25 * last_loss ? 0 : without_progress + 1;
    last_loss = equations.loss();
    const bool under_threshold = std::sqrt(equations.loss()) < threshold;
    if (!under_threshold && without_progress >= 3) run.stop = Stop::stagnation;
    if (!under_threshold && run.iterations >= most) run.stop = Stop::iterations;
    if (run.stop != Stop::none) break;
    equations.factor(system, run.loop);
    // Once under the threshold one more step shows that it is small and takes the orbit to rounding level.
    const Eigen::VectorXd step = inner.solve(equations, -equations.residual(), of_steps).head(unknowns.size());
    const loop::Loop moved =
        unknowns.moved(run.loop, std::span<const double>(step.data(), static_cast<std::size_t>(step.size())));
    run.newton_step = step.norm();
    if (!(moved.period > 0.0) || !std::isfinite(moved.period)) {
      run.loop = moved;
      return run;
    }
    run.loop = moved;
    if (!under_threshold) {
      ++run.iterations;
      continue;
    }
    run.stop = Stop::threshold;
    if (want_flat_direction) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(equations.size());
      unit(image.size()) = 1.0;
      run.flat_direction = inner.solve(equations, unit, of_flat_direction).head(unknowns.size()).normalized();
    }
  }
  run.inner_iterations = inner.iterations();
  return run;
}

}  // namespace orbweaver::corrector
