#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "orbweaver/corrector/correct.hpp"
#include "tao_solver.hpp"

namespace orbweaver::corrector {

/// What the matrix-free Newton iteration left; like TaoRun, but with the last step and the flat direction.
struct NewtonKrylovRun {
  loop::Loop loop;
  std::shared_ptr<const systems::System> system;  ///< with the parameters that it came to
  Stop stop = Stop::none;
  int iterations = 0;
  int inner_iterations = 0;
  double newton_step = 0.0;
  std::optional<Eigen::VectorXd> flat_direction;
};

/// True where the problem is square in loop space: as many projected residuals and conditions as unknowns, counting an
/// unfolding multiple of grad H where a conservative system has a phase condition (docs/mathematics.md, "Fast Newton").
[[nodiscard]] bool newton_krylov_applies(const systems::System& system, const loss::Unknowns& unknowns,
                                         const loss::Slice& slice);

/// Newton's method on the residual projected onto the modes of its symmetry type, each step by GMRES with the box
/// scheme as preconditioner: O(K log K) time and O(K) memory. The slice's first condition is the normal of the flat
/// direction. Throws NumericalError or NotFiniteError as the loss and the box scheme do.
[[nodiscard]] NewtonKrylovRun run_newton_krylov(const systems::System& system, const loop::Loop& guess,
                                                const loss::Unknowns& unknowns, const loss::Slice& slice,
                                                const Options& options, bool want_flat_direction);

}  // namespace orbweaver::corrector
