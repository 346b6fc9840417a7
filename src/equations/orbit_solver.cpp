#include "orbweaver/equations/orbit_solver.hpp"

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::equations {

PetscErrorCode OrbitSolver::run(Tao tao) {
  void* context = nullptr;
  PetscErrorCode code = TaoShellGetContext(tao, &context);
  if (code != 0) return code;
  auto* self = static_cast<OrbitSolver*>(context);
  code = TaoSetConvergedReason(tao, TAO_CONTINUE_ITERATING);
  if (code != 0) return code;
  code = self->_guard.run([self] {
    Call& call = self->_call;
    call.result = self->_solver.solve(*call.equations, *call.u, call.has_factor, *call.options);
  });
  if (code != 0) return code;
  return TaoSetConvergedReason(tao, self->_call.result.converged ? TAO_CONVERGED_USER : TAO_DIVERGED_USER);
}

void OrbitSolver::set_up(int size) {
  if (size == _size) return;
  core::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, nullptr, _vector.put()), "VecCreateSeqWithArray");
  core::check(TaoCreate(PETSC_COMM_SELF, _tao.put()), "TaoCreate");
  core::check(TaoSetOptionsPrefix(_tao.get(), "orbit_"), "TaoSetOptionsPrefix");
  core::check(TaoSetType(_tao.get(), TAOSHELL), "TaoSetType");
  core::check(TaoShellSetContext(_tao.get(), this), "TaoShellSetContext");
  core::check(TaoShellSetSolve(_tao.get(), &OrbitSolver::run), "TaoShellSetSolve");
  core::check(TaoSetSolution(_tao.get(), _vector.get()), "TaoSetSolution");
  core::check(TaoSetFromOptions(_tao.get()), "TaoSetFromOptions");
  _size = size;
}

AndersonSolver::Result OrbitSolver::solve(PreconditionedEquations& equations, std::vector<double>& u, bool has_factor,
                                          const AndersonSolver::Options& options) {
  const core::LogStage stage(core::Stage::corrector);
  set_up(equations.size());
  // The object may have moved since the last solve.
  core::check(TaoShellSetContext(_tao.get(), this), "TaoShellSetContext");
  core::check(VecPlaceArray(_vector.get(), u.data()), "VecPlaceArray");
  _call = {&equations, &u, has_factor, &options, {}};
  const PetscErrorCode code = TaoSolve(_tao.get());
  VecResetArray(_vector.get());
  _guard.rethrow();
  core::check(code, "TaoSolve");
  return std::move(_call.result);
}

}  // namespace orbweaver::equations
