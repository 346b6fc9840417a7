#include "point_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>

#include <fmt/format.h>

#include "collocation_problem.hpp"
#include "loop_problem.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/system_at.hpp"

namespace orbweaver::continuation {

namespace {

/// Steps of the secant method on the energy that a family holds, and the error at which they end, in parts of 1 + |E|.
constexpr int most_for_energy = 8;
constexpr double energy_rounding = 1e-14;
/// What they may leave where they come no further: an error of the states, in parts of 1 + |z_i|.
constexpr double state_left = 1e-11;
/// The slope of the energy over its condition is 1 to first order where the prediction is an orbit. Steeper and flatter
/// ones by more than this are taken for rounding.
constexpr double slope_within = 100.0;

double energy_left(const systems::System& family, const loop::Loop& loop) {
  const std::vector<double> state = loop::state_at(loop, 0.0);
  std::vector<double> gradient(state.size());
  loop::system_at(family, loop)->conserved_gradient(0, state, gradient);
  double left = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) left += std::abs(gradient[i]) * (1.0 + std::abs(state[i]));
  return state_left * left;
}

}  // namespace

bool winds(const std::vector<double>& winding) {
  return std::any_of(winding.begin(), winding.end(), [](double n) { return n != 0.0; });
}

double extent_of(const std::vector<double>& winding, double size) {
  return winds(winding) ? std::max(1.0, size) : size;
}

double tail_limit(double amplitude, double size, const Options& options) {
  // Every harmonic carries rounding of the size of the loop: no cutoff takes a tail below that.
  const double rounding = std::numeric_limits<double>::epsilon() * size;
  return std::max(options.tail_tolerance * std::min(1.0, amplitude), rounding);
}

std::vector<double> PointProblem::conditions_with(const Prediction& prediction, int held_scalar) {
  std::vector<double> conditions = conditions_at(prediction);
  std::fill_n(conditions.begin(), prediction.values.size(), 0.0);
  conditions[scalars_at() + static_cast<std::size_t>(held_scalar)] = 1.0;
  return conditions;
}

std::array<std::vector<double>, 2> PointProblem::surface_at(const std::vector<double>&, const Prediction&) {
  throw core::MisuseError("surfaces of orbits are solved for by collocation");
}

loop::Tangent PointProblem::tangent_of(const std::vector<double>& direction, const loop::Loop& at) {
  loop::Tangent tangent = change_of(direction, at);
  tangent.normalize();
  return tangent;
}

Trial PointProblem::correct(Prediction prediction, const std::vector<double>& conditions) {
  if (_family.family_scalars().hold != systems::FamilyScalars::Hold::energy)
    return solve(std::move(prediction), conditions);
  const std::size_t size = prediction.values.size();
  const auto rows = static_cast<Eigen::Index>(conditions.size() / size);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> matrix(conditions.data(), rows, static_cast<Eigen::Index>(size));
  constexpr Eigen::Index hold = 1;
  // The shift that the other conditions do not see, for a change of 1 of this one.
  const Eigen::VectorXd shift =
      matrix.transpose() * (matrix * matrix.transpose()).ldlt().solve(Eigen::VectorXd::Unit(rows, hold)).eval();
  Trial trial = solve(prediction, conditions);
  double slope = 1.0;
  double last_off = 0.0;
  double change = 0.0;
  for (int n = 0; trial.converged; ++n) {
    const bool is_resolved = resolved(trial);
    const double off = energy_of(_family, trial.loop) - _state.held_energy;
    const double rounding = energy_rounding * (1.0 + std::abs(_state.held_energy));
    if (std::abs(off) <= rounding) break;
    const bool is_held = std::abs(off) <= rounding + energy_left(_family, trial.loop);
    if (is_held && n > 0 && std::abs(off) > 0.5 * std::abs(last_off)) break;
    if (n == most_for_energy) {
      if (is_held || !is_resolved) break;  // before it has its harmonics the energy says nothing
      trial.converged = trial.is_orbit = false;
      trial.reason = fmt::format("the energy that the family holds is missed by {:.2g}", off);
      break;
    }
    if (n > 0) {
      const double seen = (off - last_off) / change;
      if (std::abs(seen) > 1.0 / slope_within && std::abs(seen) < slope_within) slope = seen;
    }
    last_off = off;
    change = -off / slope;
    Prediction next{trial.values, prediction.tangent, trial.order};
    for (std::size_t k = 0; k < size; ++k) next.values[k] += change * shift(static_cast<Eigen::Index>(k));
    Trial other = solve(std::move(next), conditions);
    other.iterations += trial.iterations;
    other.prediction_error = trial.prediction_error;
    trial = std::move(other);
  }
  return trial;
}

std::unique_ptr<PointProblem> make_point_problem(const FamilyOf& family, const Options& options, ProblemState& state) {
  using corrector::Method;
  const Method method = options.corrector.method;
  if (method == Method::automatic || method == Method::collocation) {
    const std::string obstacle = CollocationProblem::obstacle(family, options.cutoff_to);
    if (obstacle.empty()) return std::make_unique<CollocationProblem>(family, options, state);
    if (method == Method::collocation)
      throw core::InputError(
          fmt::format("the corrector `collocation` does not apply to loops of {} with the isotropy `{}`: {}; use "
                      "`automatic`, which "
                      "takes collocation where it applies, or `newton-krylov`",
                      family.system.info().name, loop::to_text(family.isotropy), obstacle));
  }
  return std::make_unique<LoopProblem>(family, options, state);
}

}  // namespace orbweaver::continuation
