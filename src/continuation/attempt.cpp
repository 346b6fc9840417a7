#include "attempt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/loss/slice.hpp"

namespace orbweaver::continuation {

double Direction::norm() const {
  double sum = period * period;
  for (const double v : modes) sum += v * v;
  return std::sqrt(sum);
}

Direction with_cutoff(Direction direction, int cutoff, int dimension) {
  direction.modes.resize((2 * static_cast<std::size_t>(cutoff) + 1) * static_cast<std::size_t>(dimension), 0.0);
  return direction;
}

double state_change(const loop::Loop& loop, const Direction& direction) {
  loop::Loop perturbation = loop;
  perturbation.modes = direction.modes;
  std::fill(perturbation.winding.begin(), perturbation.winding.end(), 0.0);
  double sum = 0.0;
  for (const double v : loop::state_at(perturbation, 0.0)) sum += v * v;
  return std::sqrt(sum);
}

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

Attempt correct_along(const systems::System& system, const loop::Loop& base, const Direction& direction, double length,
                      const loop::Isotropy& isotropy, const corrector::Options& options) {
  const loss::Unknowns unknowns{loop::Subspace(base.dimension, base.cutoff, isotropy), true};
  const auto coordinates = static_cast<std::size_t>(unknowns.subspace.size());
  Eigen::VectorXd normal(unknowns.size());
  unknowns.subspace.project(direction.modes, std::span(normal.data(), coordinates));
  normal(unknowns.size() - 1) = direction.period;
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
  attempt.tangent.modes.assign(base.modes.size(), 0.0);
  unknowns.subspace.add_to(std::span<const double>(tangent.data(), coordinates), attempt.tangent.modes);
  attempt.tangent.period = tangent(unknowns.size() - 1);
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
