#include "orbweaver/equations/damped_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "orbweaver/core/interruption.hpp"

namespace orbweaver::equations {

namespace {

/// Steps; those that lead to an orbit were seen to be 20 at most.
constexpr int most_steps = 50;
/// Parts of a step: below the least one the guess is given up.
constexpr double least_part = 1.0 / 256.0;
/// A step this short, rms over the unknowns, is left to the solver that follows.
constexpr double is_near = 1e-4;

}  // namespace

void approach(PreconditionedEquations& equations, std::vector<double>& u, int scaled_from, double scale) {
  const auto size = static_cast<Eigen::Index>(u.size());
  Eigen::Map<Eigen::VectorXd> point(u.data(), size);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(size);
  weights.tail(size - scaled_from).setConstant(scale);
  const auto step_at = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd step(size);
    equations.residual(at.data(), step.data());
    equations.precondition(step.data());
    return step;
  };
  const auto length_of = [&](const Eigen::VectorXd& step) {
    return step.allFinite() ? step.cwiseProduct(weights).norm() / std::sqrt(static_cast<double>(size))
                            : std::numeric_limits<double>::infinity();
  };
  double part = 1.0;
  for (int n = 0; n < most_steps; ++n) {
    core::interruption_point();
    equations.factor(u.data());
    const Eigen::VectorXd step = step_at(point);
    const double length = length_of(step);
    if (!std::isfinite(length) || length < is_near) return;
    Eigen::VectorXd next = point - part * step;
    while (!(length_of(step_at(next)) < (1.0 - 0.5 * part) * length)) {
      part *= 0.5;
      if (part < least_part) return;
      next = point - part * step;
    }
    point = next;
    part = std::min(1.0, 2.0 * part);
  }
}

}  // namespace orbweaver::equations
