#pragma once

#include <vector>

#include <petsctao.h>

#include "orbweaver/core/petsc/callback.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/equations/anderson.hpp"

namespace orbweaver::equations {

/// The accelerated solve as a TAO solver (TAOSHELL), so that PETSc's options, monitors and logs see it like the others.
/// The objects are made anew only when the number of unknowns changes.
class OrbitSolver {
 public:
  /// As AndersonSolver::solve. Throws what the equations throw.
  [[nodiscard]] AndersonSolver::Result solve(PreconditionedEquations& equations, std::vector<double>& u,
                                             bool has_factor, const AndersonSolver::Options& options);

 private:
  struct Call {
    PreconditionedEquations* equations;
    std::vector<double>* u;
    bool has_factor;
    const AndersonSolver::Options* options;
    AndersonSolver::Result result;
  };
  static PetscErrorCode run(Tao tao);
  void set_up(int size);

  AndersonSolver _solver;
  core::Handle<Tao> _tao;
  core::Handle<Vec> _vector;
  core::CallbackGuard _guard;
  Call _call{};
  int _size = 0;
};

}  // namespace orbweaver::equations
