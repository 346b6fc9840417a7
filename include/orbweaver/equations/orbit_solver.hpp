#pragma once

#include <optional>
#include <vector>

#include <petsctao.h>

#include "orbweaver/core/petsc/callback.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/equations/anderson.hpp"

namespace orbweaver::equations {

/// The accelerated solve as a TAO solver (TAOSHELL, prefix `collocation_`), so that PETSc's options, monitors and logs
/// see it like the others. The objects are made anew only when the number of unknowns changes.
///
/// What the options database has under the prefix goes before what the caller asks for: `tao_gatol` (the tolerance),
/// `tao_max_it` (iterations over all factors), and `rounding`, `stagnation`, `divergence`, `stale_iterations`,
/// `fresh_iterations` as in AndersonSolver::Options. `-collocation_tao_monitor` shows the iterations: the function
/// value and the residual are both the size of the change.
class OrbitSolver {
 public:
  static constexpr const char* prefix = "collocation_";

  /// As AndersonSolver::solve. Throws what the equations throw.
  [[nodiscard]] AndersonSolver::Result solve(PreconditionedEquations& equations, std::vector<double>& u,
                                             bool has_factor, const AndersonSolver::Options& options);

 private:
  struct Call {
    PreconditionedEquations* equations;
    std::vector<double>* u;
    bool has_factor;
    AndersonSolver::Options options;
    AndersonSolver::Result result;
  };
  struct OwnOptions {
    std::optional<double> rounding, stagnation, divergence;
    std::optional<int> stale_iterations, fresh_iterations;
  };
  static OwnOptions read_own_options();
  static PetscErrorCode run(Tao tao);
  void set_up(int size, const AndersonSolver::Options& options);
  /// The caller's options, where the options database has no others.
  [[nodiscard]] AndersonSolver::Options overridden(AndersonSolver::Options options);

  AndersonSolver _solver;
  core::Handle<Tao> _tao;
  core::Handle<Vec> _vector;
  core::CallbackGuard _guard;
  Call _call{};
  int _size = 0;
  OwnOptions _own;
  bool _own_tolerance = false;  // from the options database
};

}  // namespace orbweaver::equations
