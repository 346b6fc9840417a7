#include "orbweaver/corrector/correct.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "newton_krylov.hpp"
#include "objective.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/spectrum/sliced_hessian.hpp"
#include "tao_solver.hpp"

namespace orbweaver::corrector {

std::string_view name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged: return "converged";
    case Outcome::under_resolved: return "under-resolved";
    case Outcome::stalled: return "stalled";
    case Outcome::iteration_limit: return "iteration limit";
    case Outcome::period_not_positive: return "period not positive";
    case Outcome::not_finite: return "not finite";
    case Outcome::singular: return "singular";
    case Outcome::solver_failed: return "solver failed";
    case Outcome::lost_in_rounding: return "lost in rounding";
  }
  return "unknown";
}

namespace {

/// Roundings of the mean state that reach the residual through the field's Jacobian: a few, not measured.
constexpr double roundings = 4.0 * std::numeric_limits<double>::epsilon();
/// Of the estimate of what rounding leaves of a loss. Losses that fall no further are 1 to 5 times the estimate without
/// this factor (pendulums with l2 = 1e-3 and m2 = 1e3).
constexpr double of_rounding = 10.0 * std::numeric_limits<double>::epsilon();

double rms_field_jacobian(const loss::Linearization& lin) {
  double sum = 0.0;
  for (int i = 0; i < lin.dimension(); ++i)
    for (int l = 0; l < lin.dimension(); ++l) {
      const double* a = lin.field_jacobian(i, l);
      for (std::size_t j = 0; j < lin.density().size(); ++j) sum += lin.density()[j] * a[j] * a[j];
    }
  return std::sqrt(sum / lin.nodes());
}

double length(const loop::Loop& loop) {
  double sum = 0.0;
  for (const double v : loop.modes) sum += v * v;
  return std::sqrt(sum);
}

/// A loop that the loss would refuse.
bool is_lost(double period) { return !(period > 0.0) || !std::isfinite(period); }

struct Polished {
  loop::Loop loop;
  std::shared_ptr<const systems::System> system;
  double loss_rms;
  double newton_step;
  Eigen::VectorXd flat_direction;
};

// One more Newton step from the factored Hessian: shows that the step is small, and takes the orbit to rounding level.
Polished polish(const std::shared_ptr<const systems::System>& system, const loop::Loop& found,
                const loss::Unknowns& unknowns, const loss::Slice& slice, const std::optional<Eigen::VectorXd>& normal,
                bool apply_step) {
  const loss::Linearization lin(*system, found, loss::Linearization::Order::jacobian, unknowns.scalars);
  const spectrum::SlicedHessian hessian(lin, unknowns, slice);
  const Eigen::VectorXd step = hessian.newton_step();
  Polished out{found, system, std::sqrt(lin.loss()), step.norm(), {}};
  if (normal) out.flat_direction = hessian.flat_direction(*normal);
  if (!apply_step) return out;
  const std::span<const double> by(step.data(), static_cast<std::size_t>(step.size()));
  const loop::Loop moved = unknowns.moved(found, by);
  if (is_lost(moved.period)) return out;
  const std::shared_ptr<const systems::System> there = unknowns.moved(*system, by);
  const loss::Linearization after(*there, moved, loss::Linearization::Order::residual);
  if (std::sqrt(after.loss()) <= out.loss_rms) {
    out.loop = moved;
    out.system = there;
    out.loss_rms = std::sqrt(after.loss());
  }
  return out;
}

// The residual that the truncation leaves is about rate K tail: only where that explains the loss do more harmonics
// help.
bool tail_explains(const loop::Loop& loop, double loss_rms, double threshold, const Options& options) {
  // A tail of the size of the modes' own rounding says nothing of the resolution.
  if (loop::tail(loop) <= std::numeric_limits<double>::epsilon() * loop::rms_size(loop)) return false;
  const double truncation = 2.0 * M_PI / loop.period * loop.cutoff * loop::tail(loop);
  return truncation > options.tail_tolerance * threshold && truncation > least_explained * loss_rms;
}

Outcome outcome_of(Stop stop, const loop::Loop& loop, double loss_rms, double threshold, const Options& options) {
  switch (stop) {
    case Stop::threshold: return Outcome::converged;
    case Stop::iterations:
    case Stop::stagnation:
    case Stop::tao:
      if (is_second_order(options.method) && tail_explains(loop, loss_rms, threshold, options))
        return Outcome::under_resolved;
      return stop == Stop::iterations   ? Outcome::iteration_limit
             : stop == Stop::stagnation ? Outcome::stalled
                                        : Outcome::solver_failed;
    case Stop::none: break;
  }
  return Outcome::solver_failed;
}

}  // namespace

double state_rounding(double size, double field_jacobian) { return roundings * size * field_jacobian; }

double least_known_speed(double size, double field_jacobian) {
  return state_rounding(size, field_jacobian) / largest_unknown;
}

std::string lost_in_rounding_text(double speed, double size, double field_jacobian) {
  return fmt::format(
      "rounding of the state leaves {:.1e} of the speed open, {:g} is allowed: a larger amplitude is needed",
      state_rounding(size, field_jacobian) / speed, largest_unknown);
}

double acceptance_threshold(double tolerance, double speed, double size, double field_jacobian) {
  return std::max(tolerance * std::min(1.0, speed), state_rounding(size, field_jacobian));
}

double tolerance_met(double tolerance, double loss_rms, double speed, double size, double field_jacobian) {
  const double met = std::max(loss_rms, state_rounding(size, field_jacobian)) / std::min(1.0, speed);
  return met > tolerance ? met : 0.0;
}

double least_known_amplitude(const systems::System& system, const loop::Loop& rest, const loop::Tangent& direction) {
  const double speed = loop::rms_speed(loop::perturbation(rest, direction));
  try {
    const loss::Linearization at_rest(system, rest, loss::Linearization::Order::jacobian);
    return least_known_speed(loop::rms_size(rest), rms_field_jacobian(at_rest)) / speed;
  } catch (const core::NotFiniteError&) {
    return 0.0;
  }
}

double rounding_floor(int cutoff, double period, double size, double speed, double field_jacobian) {
  return of_rounding * ((2.0 * M_PI / period * cutoff + field_jacobian) * size + speed);
}

double rounding_floor(const loop::Loop& loop, const loss::Linearization& linearization) {
  const bool residual_only = linearization.order() == loss::Linearization::Order::residual;
  return rounding_floor(loop.cutoff, loop.period, loop::rms_size(loop), loop::rms_speed(loop),
                        residual_only ? 0.0 : rms_field_jacobian(linearization));
}

namespace {

double size_of_mean(const loop::Loop& loop) {
  double mean_square = 0.0;
  for (const double v : loop::mean_state(loop)) mean_square += v * v;
  return std::sqrt(mean_square);
}

}  // namespace

double acceptance_threshold(const loop::Loop& loop, const loss::Linearization& linearization, double tolerance) {
  const bool residual_only = linearization.order() == loss::Linearization::Order::residual;
  return acceptance_threshold(tolerance, loop::rms_speed(loop), size_of_mean(loop),
                              residual_only ? 0.0 : rms_field_jacobian(linearization));
}

namespace {

// Whether a run that came no further ended where rounding lets it.
bool is_at_rounding(Stop stop, const Result& result, const loss::Linearization& lin, const Options& options) {
  return (stop == Stop::stagnation || stop == Stop::iterations) && result.loss_rms >= result.threshold &&
         result.loss_rms < rounding_floor(result.loop, lin) &&
         !tail_explains(result.loop, result.loss_rms, result.threshold, options);
}

// Sets outcome and detail of a result whose loop, loss, threshold and Newton step are known; `lin`: at the loop, or
// near it.
void judge(Result& result, Stop stop, const std::string& solver_reason, const loss::Linearization& lin,
           const Options& options) {
  result.outcome = outcome_of(stop, result.loop, result.loss_rms, result.threshold, options);
  if (result.outcome != Outcome::converged) {
    result.detail = fmt::format("{} after {} iterations at sqrt(loss) = {:.3g}, wanted {:.3g}, K = {} ({})",
                                name_of(result.outcome), result.iterations, result.loss_rms, result.threshold,
                                result.loop.cutoff, solver_reason);
    return;
  }
  const double speed = loop::rms_speed(result.loop);
  const double size = size_of_mean(result.loop);
  const double jacobian = rms_field_jacobian(lin);
  if (speed < least_known_speed(size, jacobian)) {
    result.outcome = Outcome::lost_in_rounding;
    result.detail = lost_in_rounding_text(speed, size, jacobian);
    return;
  }
  // The period is open by what rounding leaves of the speed.
  const double open = state_rounding(size, jacobian) / speed * result.loop.period;
  if (result.newton_step > std::max(options.step_tolerance * (1.0 + length(result.loop)), open)) {
    result.outcome = Outcome::stalled;
    result.detail = fmt::format(
        "sqrt(loss) = {:.3g} is under its threshold, but the Newton step is still {:.3g}: the loss is flat in "
        "more than one direction here",
        result.loss_rms, result.newton_step);
    return;
  }
  result.tolerance_met = tolerance_met(options.tolerance, result.loss_rms, speed, size, jacobian);
}

Result period_lost(Result result, const systems::System& system) {
  result.outcome = Outcome::period_not_positive;
  result.detail = fmt::format("the period became {:.6g}", result.loop.period * system.scales().time);
  return result;
}

Result correct_by_tao(const systems::System& system, const loop::Loop& guess, const loss::Unknowns& unknowns,
                      const loss::Slice& slice, const Options& options, const std::optional<Eigen::VectorXd>& normal) {
  const auto order = options.curvature == loss::Curvature::full ? loss::Linearization::Order::second
                                                                : loss::Linearization::Order::jacobian;
  Result result;
  Objective objective(system, guess, unknowns, slice, order);
  const TaoRun run = run_tao(objective, options);
  result.iterations = run.iterations;
  result.loop = objective.loop_at(run.x);
  const std::shared_ptr<const systems::System> here = objective.system_at(run.x);
  result.parameters = unknowns.parameters_of(*here);
  if (is_lost(result.loop.period)) return period_lost(result, system);
  const loss::Linearization& lin = objective.at(run.x);
  result.loss_rms = std::sqrt(lin.loss());
  result.threshold = acceptance_threshold(result.loop, lin, options.tolerance);
  result.at_rounding = is_at_rounding(run.stop, result, lin, options);
  const Stop stop = result.at_rounding ? Stop::threshold : run.stop;
  if (stop == Stop::threshold) {
    const Polished polished = polish(here, result.loop, unknowns, slice, normal, is_second_order(options.method));
    result.loop = polished.loop;
    result.parameters = unknowns.parameters_of(*polished.system);
    result.loss_rms = polished.loss_rms;
    result.newton_step = polished.newton_step;
    if (normal) result.flat_direction = polished.flat_direction;
  }
  judge(result, stop, fmt::format("TAO: {}", run.tao_reason), lin, options);
  return result;
}

Result correct_by_newton_krylov(const systems::System& system, const loop::Loop& guess, const loss::Unknowns& unknowns,
                                const loss::Slice& slice, const Options& options, bool want_flat_direction) {
  NewtonKrylovRun run = run_newton_krylov(system, guess, unknowns, slice, options, want_flat_direction);
  Result result;
  result.loop = std::move(run.loop);
  result.parameters = unknowns.parameters_of(*run.system);
  result.iterations = run.iterations;
  result.inner_iterations = run.inner_iterations;
  result.newton_step = run.newton_step;
  result.flat_direction = std::move(run.flat_direction);
  if (is_lost(result.loop.period)) return period_lost(result, system);
  const loss::Linearization lin(*run.system, result.loop, loss::Linearization::Order::jacobian);
  result.loss_rms = std::sqrt(lin.loss());
  result.threshold = acceptance_threshold(result.loop, lin, options.tolerance);
  const bool kept = result.loss_rms < result.threshold;
  const Stop stop = run.stop == Stop::threshold && !kept ? Stop::stagnation : run.stop;
  result.at_rounding = is_at_rounding(stop, result, lin, options);
  judge(result, result.at_rounding ? Stop::threshold : stop, "newton-krylov", lin, options);
  return result;
}

Result dispatch(const systems::System& system, const loop::Loop& guess, const loss::Unknowns& unknowns,
                const loss::Slice& slice, const Options& options, const std::optional<Eigen::VectorXd>& normal) {
  const bool large = unknowns.size() >= options.krylov_from;
  const bool wanted = options.method == Method::newton_krylov || (options.method == Method::automatic && large);
  if (!wanted || !newton_krylov_applies(system, unknowns, slice)) {
    if (options.method == Method::newton_krylov)
      throw core::InputError(
          "corrector newton-krylov needs a square problem (a free period, and as many other scalars or conserved "
          "quantities as further conditions): use `automatic`");
    return correct_by_tao(system, guess, unknowns, slice, options, normal);
  }
  if (options.method == Method::newton_krylov)
    return correct_by_newton_krylov(system, guess, unknowns, slice, options, normal.has_value());
  try {
    return correct_by_newton_krylov(system, guess, unknowns, slice, options, normal.has_value());
  } catch (const core::NotFiniteError&) {
    throw;
  } catch (const core::NumericalError&) {
    if (unknowns.size() > largest_dense) throw;
    return correct_by_tao(system, guess, unknowns, slice, options, normal);
  }
}

}  // namespace

Result correct(const systems::System& family, const loop::Loop& guess, const loss::Unknowns& unknowns,
               const loss::Slice& slice, const Options& options, const std::optional<Eigen::VectorXd>& normal) {
  const core::LogStage stage(core::Stage::corrector);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, guess);
  const systems::System& system = *here;
  core::require(slice.unknowns() == unknowns.size(), "the slice belongs to other unknowns");
  Result result;
  result.loop = guess;
  result.parameters = unknowns.parameters_of(system);
  if (is_lost(guess.period)) {
    result.outcome = Outcome::period_not_positive;
    result.detail = fmt::format("the guess has the period {:.6g}", guess.period * system.scales().time);
    return result;
  }
  Options own = options;
  if (own.method == Method::collocation) own.method = Method::automatic;  // a method for branches
  try {
    return dispatch(system, guess, unknowns, slice, own, normal);
  } catch (const core::NotFiniteError& error) {
    result.outcome = Outcome::not_finite;
    result.detail = error.what();
  } catch (const core::NumericalError& error) {
    result.outcome = Outcome::singular;
    result.detail = error.what();
  }
  return result;
}

}  // namespace orbweaver::corrector
