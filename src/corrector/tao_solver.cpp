#include "tao_solver.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <petsctao.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/loss/dense.hpp"
#include "rprop.hpp"

namespace orbweaver::corrector {

namespace {

/// Added to the diagonal of J'J in parts of each entry, so that Cholesky meets no negative pivot of rounding size: not
/// a multiple of the norm, since the period's entry is as small as the square of the amplitude.
constexpr double raised_diagonal = 4.0 * std::numeric_limits<double>::epsilon();
/// The residual where none is defined: finite, since TAO refuses infinite ones, and its square is too.
constexpr double undefined_residual = 1e100;
/// The paper's optimiser takes 150 to 650 gradients for a step (docs/performance.md): this ends hopeless runs only.
constexpr int most_first_order_steps = 200'000;
/// Of the limit on iterations: a line search takes a few evaluations each, so that the iterations' limit decides.
constexpr int evaluations_an_iteration = 100;

struct Context {
  Objective& objective;
  const Options& options;
  int max_iterations;
  core::CallbackGuard guard{};
  Stop stop = Stop::none;
  double last_loss = std::numeric_limits<double>::infinity();
  int without_progress = 0;
};

Context& context_of(void* raw) { return *static_cast<Context*>(raw); }

void copy_matrix(const core::Handle<Mat>& from, Mat to) {
  core::check(MatCopy(from.get(), to, SAME_NONZERO_PATTERN), "MatCopy");
}

PetscErrorCode objective_and_gradient(Tao, Vec x, PetscReal* value, Vec gradient, void* raw) {
  Context& c = context_of(raw);
  return c.guard.run([&] {
    const Eigen::VectorXd point = loss::to_eigen(x);
    if (!c.objective.defined_at(point)) {
      *value = std::numeric_limits<double>::infinity();
      loss::assign(gradient, Eigen::VectorXd::Zero(point.size()));
      return;
    }
    *value = c.objective.at(point).loss();
    loss::assign(gradient, c.objective.gradient(point));
  });
}

PetscErrorCode hessian(Tao, Vec x, Mat h, Mat, void* raw) {
  Context& c = context_of(raw);
  return c.guard.run([&] {
    c.objective.hessian(loss::to_eigen(x), c.options.curvature, core::Handle<Mat>::share(h));
    if (c.options.curvature != loss::Curvature::gauss_newton) return;
    core::Handle<Vec> diagonal;
    core::check(MatCreateVecs(h, diagonal.put(), nullptr), "MatCreateVecs");
    core::check(MatGetDiagonal(h, diagonal.get()), "MatGetDiagonal");
    core::check(VecScale(diagonal.get(), raised_diagonal), "VecScale");
    core::check(MatDiagonalSet(h, diagonal.get(), ADD_VALUES), "MatDiagonalSet");
    core::check(MatSetOption(h, MAT_SPD, PETSC_TRUE), "MatSetOption");
  });
}

PetscErrorCode residual(Tao, Vec x, Vec r, void* raw) {
  Context& c = context_of(raw);
  return c.guard.run([&] {
    const Eigen::VectorXd point = loss::to_eigen(x);
    if (!c.objective.defined_at(point)) {
      // If a solver steps here all the same, the test below ends the run.
      loss::assign(r, Eigen::VectorXd::Constant(c.objective.rows(), undefined_residual));
      return;
    }
    const std::vector<double> values = c.objective.at(point).residual();
    loss::assign(r, loss::ConstVectorMap(values.data(), static_cast<Eigen::Index>(values.size())));
  });
}

PetscErrorCode residual_jacobian(Tao, Vec x, Mat j, Mat, void* raw) {
  Context& c = context_of(raw);
  return c.guard.run([&] {
    const Eigen::VectorXd point = loss::to_eigen(x);
    if (c.objective.defined_at(point))
      copy_matrix(c.objective.jacobian(point), j);
    else
      core::check(MatZeroEntries(j), "MatZeroEntries");
  });
}

// One test for every type: sqrt(loss) against the threshold, else stagnation (second order only), else the limit.
PetscErrorCode convergence_test(Tao tao, void* raw) {
  Context& c = context_of(raw);
  return c.guard.run([&] {
    Vec solution = nullptr;
    PetscInt iteration = 0;
    core::check(TaoGetSolution(tao, &solution), "TaoGetSolution");
    core::check(TaoGetIterationNumber(tao, &iteration), "TaoGetIterationNumber");
    const Eigen::VectorXd x = loss::to_eigen(solution);
    if (!c.objective.defined_at(x)) {
      core::check(TaoSetConvergedReason(tao, TAO_DIVERGED_USER), "TaoSetConvergedReason");
      return;
    }
    const loss::Linearization& lin = c.objective.at(x);
    const double threshold = acceptance_threshold(c.objective.loop_at(x), lin, c.options.tolerance);
    const bool progress = lin.loss() < least_progress * c.last_loss;
    c.without_progress = progress ? 0 : c.without_progress + 1;
    c.last_loss = lin.loss();
    if (std::sqrt(lin.loss()) < threshold) {
      c.stop = Stop::threshold;
    } else if (is_second_order(c.options.method) && iteration >= most_without_progress &&
               c.without_progress >= most_without_progress) {
      c.stop = Stop::stagnation;
    } else if (iteration >= c.max_iterations) {
      c.stop = Stop::iterations;
    } else {
      core::check(TaoSetConvergedReason(tao, TAO_CONTINUE_ITERATING), "TaoSetConvergedReason");
      return;
    }
    core::check(TaoSetConvergedReason(tao, c.stop == Stop::threshold ? TAO_CONVERGED_USER : TAO_DIVERGED_USER),
                "TaoSetConvergedReason");
  });
}

TaoType type_of(Method method) {
  switch (method) {
    case Method::automatic:
    case Method::collocation:
    case Method::newton_krylov: break;
    case Method::brgn: return TAOBRGN;
    case Method::nls: return TAONLS;
    case Method::ntr: return TAONTR;
    case Method::lmvm: return TAOLMVM;
    case Method::rprop: return "orbweaver_rprop";
    case Method::rprop_extrapolated: return "orbweaver_rprop_extrapolated";
  }
  return TAONLS;
}

void default_option(const char* name, const char* value) {
  PetscBool set = PETSC_FALSE;
  core::check(PetscOptionsHasName(nullptr, nullptr, name, &set), "PetscOptionsHasName");
  if (set == PETSC_FALSE) core::check(PetscOptionsSetValue(nullptr, name, value), "PetscOptionsSetValue");
}

void solve_directly(Tao tao, KSPType type) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  core::check(TaoGetKSP(tao, &ksp), "TaoGetKSP");
  core::check(KSPSetType(ksp, type), "KSPSetType");
  core::check(KSPGetPC(ksp, &pc), "KSPGetPC");
  core::check(PCSetType(pc, PCCHOLESKY), "PCSetType");
}

}  // namespace

TaoRun run_tao(Objective& objective, const Options& options) {
  register_rprop();
  const int size = objective.slice().free();
  const bool second_order = is_second_order(options.method);
  Context context{objective, options,
                  options.max_iterations > 0 ? options.max_iterations
                                             : (second_order ? most_newton_steps : most_first_order_steps)};

  const core::Handle<Vec> x = loss::create_vector(size);
  core::Handle<Mat> matrix;
  core::Handle<Vec> residual_vector;
  core::Handle<Tao> tao;
  core::check(TaoCreate(PETSC_COMM_SELF, tao.put()), "TaoCreate");
  core::check(TaoSetOptionsPrefix(tao.get(), "corrector_"), "TaoSetOptionsPrefix");
  if (options.method == Method::brgn) {
    default_option("-corrector_tao_brgn_regularization_type", "lm");
    default_option("-corrector_tao_brgn_regularizer_weight", "1e-10");
    default_option("-corrector_tao_brgn_mat_explicit", "true");
  }
  core::check(TaoSetType(tao.get(), type_of(options.method)), "TaoSetType");
  core::check(TaoSetSolution(tao.get(), x.get()), "TaoSetSolution");
  core::check(TaoSetTolerances(tao.get(), 0.0, 0.0, 0.0), "TaoSetTolerances");
  core::check(TaoSetMaximumIterations(tao.get(), context.max_iterations), "TaoSetMaximumIterations");
  core::check(TaoSetMaximumFunctionEvaluations(tao.get(), evaluations_an_iteration * context.max_iterations),
              "TaoSetMaximumFunctionEvaluations");
  Tao tested = tao.get();
  if (options.method == Method::brgn) {
    residual_vector = loss::create_vector(objective.rows());
    matrix = loss::create_dense(objective.rows(), size);
    core::check(TaoSetResidualRoutine(tao.get(), residual_vector.get(), residual, &context), "TaoSetResidualRoutine");
    core::check(TaoSetJacobianResidualRoutine(tao.get(), matrix.get(), matrix.get(), residual_jacobian, &context),
                "TaoSetJacobianResidualRoutine");
    core::check(TaoBRGNGetSubsolver(tao.get(), &tested), "TaoBRGNGetSubsolver");
    core::check(TaoSetTolerances(tested, 0.0, 0.0, 0.0), "TaoSetTolerances");
    core::check(TaoSetMaximumIterations(tested, context.max_iterations), "TaoSetMaximumIterations");
  } else {
    core::check(TaoSetObjectiveAndGradient(tao.get(), nullptr, objective_and_gradient, &context),
                "TaoSetObjectiveAndGradient");
    if (second_order) {
      matrix = loss::create_dense(size, size);
      core::check(TaoSetHessian(tao.get(), matrix.get(), matrix.get(), hessian, &context), "TaoSetHessian");
    }
  }
  if (options.method == Method::nls || options.method == Method::automatic) solve_directly(tao.get(), KSPPREONLY);
  if (options.method == Method::ntr) solve_directly(tao.get(), KSPSTCG);
  core::check(TaoSetFromOptions(tao.get()), "TaoSetFromOptions");
  if (options.method == Method::brgn) {
    // TaoSetUp evaluates the guess, and one that fails leaves its vectors behind (PETSc 3.18): it is evaluated first.
    const Eigen::VectorXd guess = loss::to_eigen(x.get());
    if (objective.defined_at(guess)) (void)objective.jacobian(guess);
    const PetscErrorCode set_up = TaoSetUp(tao.get());
    context.guard.rethrow();
    core::check(set_up, "TaoSetUp");
    solve_directly(tested, KSPPREONLY);
  }
  core::check(TaoSetConvergenceTest(tested, convergence_test, &context), "TaoSetConvergenceTest");

  const PetscErrorCode code = TaoSolve(tao.get());
  context.guard.rethrow();
  if (code == PETSC_ERR_MAT_CH_ZRPVT || code == PETSC_ERR_MAT_LU_ZRPVT)
    throw core::NumericalError(
        "the Hessian on the slice has a pivot that is not positive: the loss is flat in more than one direction");
  core::check(code, "TaoSolve");

  TaoRun run;
  PetscInt iterations = 0;
  TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
  core::check(TaoGetIterationNumber(tested, &iterations), "TaoGetIterationNumber");
  core::check(TaoGetConvergedReason(tested, &reason), "TaoGetConvergedReason");
  run.x = loss::to_eigen(x.get());
  run.iterations = static_cast<int>(iterations);
  run.stop = context.stop == Stop::none ? Stop::tao : context.stop;
  run.tao_reason = TaoConvergedReasons[reason];
  return run;
}

}  // namespace orbweaver::corrector
