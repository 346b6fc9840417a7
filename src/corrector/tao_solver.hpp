#pragma once

#include <string>

#include <Eigen/Dense>

#include "objective.hpp"
#include "orbweaver/core/petsc/callback.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::corrector {

/// Why the iteration stopped, in our own terms: TAO's convergence test is ours (the convergence callback of
/// tao_solver.cpp), whatever the type.
enum class Stop { none, threshold, stagnation, iterations, tao };

/// Second-order methods stagnate after so many steps in a row that did not bring the loss to this share of the one
/// before: a Newton step on its way gains far more. Where `Options::max_iterations` is 0 they may take so many steps:
/// quadratic convergence needs a handful.
inline constexpr double least_progress = 0.25;
inline constexpr int most_without_progress = 3;
inline constexpr int most_newton_steps = 30;

/// What one run of a TAO solver left.
struct TaoRun {
  Eigen::VectorXd x;
  Stop stop = Stop::none;
  int iterations = 0;
  std::string tao_reason;
};

/// Runs the TAO type of `options.method` on the objective from x = 0. Throws what a callback threw.
[[nodiscard]] TaoRun run_tao(Objective& objective, const Options& options);

}  // namespace orbweaver::corrector
