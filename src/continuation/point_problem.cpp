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

namespace orbweaver::continuation {

namespace {

/// Newton's steps on the energy that a family holds, and the error that they may leave, in parts of 1 + |E|.
constexpr int most_for_energy = 6;
constexpr double energy_rounding = 1e-14;
/// The error, in the same parts, with which an orbit is none of a family that holds the energy; where the orbit is
/// known to less (its threshold), that.
constexpr double energy_missed = 1e-8;

}  // namespace

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

loop::Tangent PointProblem::change_of(const std::vector<double>&, const loop::Loop&) {
  throw core::MisuseError("surfaces of orbits are solved for by collocation");
}

Trial PointProblem::correct(Prediction prediction, const std::vector<double>& conditions) {
  if (_family.family_scalars().hold != systems::FamilyScalars::Hold::energy)
    return solve(std::move(prediction), conditions);
  const std::size_t size = prediction.values.size();
  const auto rows = static_cast<Eigen::Index>(conditions.size() / size);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> matrix(conditions.data(), rows, static_cast<Eigen::Index>(size));
  constexpr Eigen::Index hold = 1;
  Trial trial = solve(prediction, conditions);
  const double unit = 1.0 + std::abs(_state.held_energy);
  for (int n = 0; trial.converged; ++n) {
    static_cast<void>(resolved(trial));
    const double off = energy_of(_family, trial.loop) - _state.held_energy;
    if (std::abs(off) <= energy_rounding * unit) break;
    if (n == most_for_energy) {
      if (std::abs(off) <= std::max(energy_missed, trial.threshold) * unit) break;
      trial.converged = trial.is_orbit = false;
      trial.reason = fmt::format("its energy is {:.2g} from the one that the family holds", off);
      break;
    }
    // The shift that the other conditions do not see.
    const Eigen::VectorXd factors =
        (matrix * matrix.transpose()).ldlt().solve(-off * Eigen::VectorXd::Unit(rows, hold));
    const Eigen::VectorXd shift = matrix.transpose() * factors;
    Prediction next{trial.values, prediction.tangent, trial.order};
    for (std::size_t k = 0; k < size; ++k) next.values[k] += shift(static_cast<Eigen::Index>(k));
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
