#include "newton_krylov.hpp"

#include <cmath>
#include <limits>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/equations/loop_solver.hpp"

namespace orbweaver::corrector {

namespace {

/// A step's error is squared away by the next.
constexpr equations::LoopSolver::Accuracy of_steps{1e-8, 1e-5};
/// Nothing corrects a tangent afterwards, so it is solved to rounding.
constexpr equations::LoopSolver::Accuracy of_flat_direction{1e-13, 1e-8};

}  // namespace

bool newton_krylov_applies(const systems::System& system, const loss::Unknowns& unknowns, const loss::Slice& slice) {
  if (!unknowns.has_period() || slice.conditions().cols() < 1) return false;
  return equations::LoopEquations::are_square(system, unknowns, unknowns.subspace.image(), slice);
}

NewtonKrylovRun run_newton_krylov(const systems::System& system, const loop::Loop& guess,
                                  const loss::Unknowns& unknowns, const loss::Slice& slice, const Options& options,
                                  bool want_flat_direction) {
  const loop::Subspace image = unknowns.subspace.image();
  const int most = options.max_iterations > 0 ? options.max_iterations : most_newton_steps;
  NewtonKrylovRun run;
  run.loop = guess;
  run.system = {std::shared_ptr<const systems::System>(), &system};
  core::Team* const team = core::worth_dividing(options.team, system.dimension());
  equations::LoopSolver inner(unknowns.size() + equations::LoopEquations::unfoldings(unknowns, image, slice),
                              "corrector_inner_");
  double last_loss = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  while (run.stop == Stop::none) {
    core::interruption_point();
    equations::LoopEquations equations(*run.system, run.loop, unknowns, image, slice, team);
    const double threshold = acceptance_threshold(run.loop, equations.linearization(), options.tolerance);
    without_progress = equations.loss() < least_progress * last_loss ? 0 : without_progress + 1;
    last_loss = equations.loss();
    // Where rounding lets the loss fall no further the tolerance is met as far as it can be.
    const bool at_rounding = without_progress >= most_without_progress &&
                             std::sqrt(equations.loss()) < rounding_floor(run.loop, equations.linearization());
    const bool under_threshold = std::sqrt(equations.loss()) < threshold || at_rounding;
    if (!under_threshold && without_progress >= most_without_progress) run.stop = Stop::stagnation;
    if (!under_threshold && run.iterations >= most) run.stop = Stop::iterations;
    if (run.stop != Stop::none) break;
    equations.factor(*run.system, run.loop);
    // Once under the threshold one more step shows that it is small and takes the orbit to rounding level.
    const Eigen::VectorXd step = inner.solve(equations, -equations.residual(), of_steps).head(unknowns.size());
    const std::span<const double> by(step.data(), static_cast<std::size_t>(step.size()));
    const loop::Loop moved = unknowns.moved(run.loop, by);
    run.system = unknowns.moved(*run.system, by);
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
