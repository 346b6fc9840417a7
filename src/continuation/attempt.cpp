#include "attempt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/loss/slice.hpp"

namespace orbweaver::continuation {

Eigen::MatrixXd conditions_at(const loop::Loop& guess, const loss::Unknowns& unknowns, const Eigen::VectorXd& normal) {
  std::vector<double> shift = unknowns.time_shift_direction(guess);
  const Eigen::Map<const Eigen::VectorXd> direction(shift.data(), static_cast<Eigen::Index>(shift.size()));
  const double length = direction.norm();
  if (length <= 1e-8 * loop::rms_amplitude(guess)) return normal;
  Eigen::MatrixXd conditions(normal.size(), 2);
  conditions << normal, direction / length;
  return conditions;
}

namespace {

// A tangent does not shift the phase.
Eigen::VectorXd without_shift(const Eigen::MatrixXd& conditions) {
  Eigen::VectorXd normal = conditions.col(0);
  if (conditions.cols() > 1) normal -= conditions.col(1).dot(normal) * conditions.col(1);
  return normal.normalized();
}

}  // namespace

Attempt correct_along(const systems::System& system, const loop::Loop& base, const loop::Tangent& direction,
                      double length, const loop::Isotropy& isotropy, const corrector::Options& options) {
  const loss::Unknowns unknowns{loop::Subspace(base.dimension, base.cutoff, isotropy), {loss::Scalar::period()}};
  const std::vector<double> along = unknowns.coordinates_of(direction);
  Eigen::VectorXd normal = Eigen::Map<const Eigen::VectorXd>(along.data(), unknowns.size());
  normal.normalize();
  const Eigen::VectorXd move = length * normal;
  Attempt attempt;
  const loop::Loop guess =
      unknowns.moved(base, std::span<const double>(move.data(), static_cast<std::size_t>(move.size())));
  if (!(guess.period > 0.0)) {
    attempt.result.outcome = corrector::Outcome::period_not_positive;
    attempt.result.detail = fmt::format("the predicted period is {:.6g}", guess.period);
    return attempt;
  }
  const Eigen::MatrixXd conditions = conditions_at(guess, unknowns, normal);
  normal = without_shift(conditions);
  attempt.result =
      corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options, normal);
  if (!attempt.result.converged()) return attempt;
  const Eigen::VectorXd& tangent = attempt.result.flat_direction.value();
  attempt.turning = std::acos(std::clamp(tangent.dot(normal), -1.0, 1.0));
  attempt.tangent = unknowns.tangent_of(std::span(tangent.data(), static_cast<std::size_t>(tangent.size())));
  return attempt;
}

double tail_limit(const loop::Loop& loop, const Options& options) {
  // Every harmonic carries rounding of the size of the loop: no cutoff takes a tail below that.
  const double rounding = std::numeric_limits<double>::epsilon() * loop::rms_size(loop);
  return std::max(options.tail_tolerance * std::min(1.0, loop::rms_amplitude(loop)), rounding);
}

bool needs_more_harmonics(const corrector::Result& result, const Options& options) {
  if (result.outcome == corrector::Outcome::under_resolved) return true;
  return result.converged() && loop::tail(result.loop) > tail_limit(result.loop, options);
}

}  // namespace orbweaver::continuation
