#include "orbweaver/equations/orbit_solver.hpp"

#include <cmath>

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::equations {

OrbitSolver::OwnOptions OrbitSolver::read_own_options() {
  OwnOptions own;
  const AndersonSolver::Options defaults;
  // The name is what the macros of PETSc look for.
  const auto real = [&](PetscOptionItems* PetscOptionsObject, const char* name, const char* help, double usual,
                        std::optional<double>& value) {
    PetscReal read = usual;
    PetscBool given = PETSC_FALSE;
    PetscCall(PetscOptionsReal(name, help, "OrbitSolver", usual, &read, &given));
    if (given == PETSC_TRUE) value = read;
    return PetscErrorCode{0};
  };
  const auto integer = [&](PetscOptionItems* PetscOptionsObject, const char* name, const char* help, int usual,
                           std::optional<int>& value) {
    PetscInt read = usual;
    PetscBool given = PETSC_FALSE;
    PetscCall(PetscOptionsInt(name, help, "OrbitSolver", usual, &read, &given));
    if (given == PETSC_TRUE) value = static_cast<int>(read);
    return PetscErrorCode{0};
  };
  const auto read_all = [&] {
    PetscOptionsBegin(PETSC_COMM_SELF, prefix, "Collocation solver", "OrbitSolver");
    PetscCall(
        real(PetscOptionsObject, "-rounding", "A change this small is at rounding", defaults.rounding, own.rounding));
    PetscCall(real(PetscOptionsObject, "-stagnation", "Tolerances within which a stagnant solve ends",
                   defaults.stagnation, own.stagnation));
    PetscCall(real(PetscOptionsObject, "-divergence", "A change this large is a failure", defaults.divergence,
                   own.divergence));
    PetscCall(integer(PetscOptionsObject, "-stale_iterations", "Iterations with a kept factor",
                      defaults.stale_iterations, own.stale_iterations));
    PetscCall(integer(PetscOptionsObject, "-fresh_iterations", "Iterations with a new factor",
                      defaults.fresh_iterations, own.fresh_iterations));
    PetscOptionsEnd();
    return PetscErrorCode{0};
  };
  core::check(read_all(), "options of the collocation solver");
  return own;
}

PetscErrorCode OrbitSolver::run(Tao tao) {
  void* context = nullptr;
  PetscErrorCode code = TaoShellGetContext(tao, &context);
  if (code != 0) return code;
  auto* self = static_cast<OrbitSolver*>(context);
  code = TaoSetConvergedReason(tao, TAO_CONTINUE_ITERATING);
  if (code != 0) return code;
  code = self->_guard.run([self, tao] {
    Call& call = self->_call;
    const auto monitor = [tao](int iteration, double size) {
      if (!std::isfinite(size)) return;  // PETSc stops at these; here a new factor may help
      core::check(TaoSetIterationNumber(tao, iteration), "TaoSetIterationNumber");
      core::check(TaoMonitor(tao, iteration, size, size, 0.0, 1.0), "TaoMonitor");
    };
    call.result = self->_solver.solve(*call.equations, *call.u, call.has_factor, call.options, monitor);
  });
  if (code != 0) return code;
  return TaoSetConvergedReason(tao, self->_call.result.converged ? TAO_CONVERGED_USER : TAO_DIVERGED_USER);
}

void OrbitSolver::set_up(int size, const AndersonSolver::Options& options) {
  if (size == _size) return;
  core::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, nullptr, _vector.put()), "VecCreateSeqWithArray");
  core::check(TaoCreate(PETSC_COMM_SELF, _tao.put()), "TaoCreate");
  core::check(TaoSetOptionsPrefix(_tao.get(), prefix), "TaoSetOptionsPrefix");
  core::check(TaoSetType(_tao.get(), TAOSHELL), "TaoSetType");
  core::check(TaoShellSetContext(_tao.get(), this), "TaoShellSetContext");
  core::check(TaoShellSetSolve(_tao.get(), &OrbitSolver::run), "TaoShellSetSolve");
  core::check(TaoSetSolution(_tao.get(), _vector.get()), "TaoSetSolution");
  core::check(TaoSetMaximumIterations(_tao.get(), options.most_iterations), "TaoSetMaximumIterations");
  core::check(TaoSetFromOptions(_tao.get()), "TaoSetFromOptions");
  PetscBool given = PETSC_FALSE;
  core::check(PetscOptionsHasName(nullptr, prefix, "-tao_gatol", &given), "PetscOptionsHasName");
  _own_tolerance = given == PETSC_TRUE;
  _own = read_own_options();
  _size = size;
}

AndersonSolver::Options OrbitSolver::overridden(AndersonSolver::Options options) {
  PetscReal tolerance = options.tolerance;
  if (_own_tolerance)
    core::check(TaoGetTolerances(_tao.get(), &tolerance, nullptr, nullptr), "TaoGetTolerances");
  else
    core::check(TaoSetTolerances(_tao.get(), tolerance, 0.0, 0.0), "TaoSetTolerances");
  options.tolerance = tolerance;
  PetscInt most = options.most_iterations;
  core::check(TaoGetMaximumIterations(_tao.get(), &most), "TaoGetMaximumIterations");
  options.most_iterations = static_cast<int>(most);
  options.rounding = _own.rounding.value_or(options.rounding);
  options.stagnation = _own.stagnation.value_or(options.stagnation);
  options.divergence = _own.divergence.value_or(options.divergence);
  options.stale_iterations = _own.stale_iterations.value_or(options.stale_iterations);
  options.fresh_iterations = _own.fresh_iterations.value_or(options.fresh_iterations);
  options.slow_iterations = _own.fresh_iterations.value_or(options.slow_iterations);
  return options;
}

AndersonSolver::Result OrbitSolver::solve(PreconditionedEquations& equations, std::vector<double>& u, bool has_factor,
                                          const AndersonSolver::Options& options) {
  const core::LogStage stage(core::Stage::corrector);
  set_up(equations.size(), options);
  // The object may have moved since the last solve.
  core::check(TaoShellSetContext(_tao.get(), this), "TaoShellSetContext");
  core::check(VecPlaceArray(_vector.get(), u.data()), "VecPlaceArray");
  _call = {&equations, &u, has_factor, overridden(options), {}};
  const PetscErrorCode code = TaoSolve(_tao.get());
  VecResetArray(_vector.get());
  _guard.rethrow();
  core::check(code, "TaoSolve");
  return std::move(_call.result);
}

}  // namespace orbweaver::equations
