#include "correction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/equations/orbit_solver.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"

namespace orbweaver::cost {

namespace {

/// Of the solver's tolerance on the nodal values to that on sqrt(loss), and what rounding leaves of nodal values: as
/// branches by collocation have them.
constexpr double of_loss_tolerance = 1e-2;
constexpr double nodal_rounding = 50.0 * std::numeric_limits<double>::epsilon();
constexpr double flattest = 1e-4;
/// Cells are counted in fours, from eight on, as those of branches.
constexpr int cells_in = 4;
constexpr int least_cells = 8;

Eigen::MatrixXd conditions_at(const Directed& guess, const loss::Unknowns& unknowns) {
  const std::vector<double> along = unknowns.coordinates_of(guess.tangent);
  const std::vector<double> shift = unknowns.time_shift_direction(guess.loop);
  const Eigen::Map<const Eigen::VectorXd> tangent(along.data(), unknowns.size());
  const Eigen::Map<const Eigen::VectorXd> phase(shift.data(), unknowns.size());
  const bool holds_phase = phase.norm() > loss::Unknowns::least_time_shift * loop::rms_amplitude(guess.loop);
  Eigen::MatrixXd conditions(unknowns.size(), holds_phase ? 2 : 1);
  conditions.col(0) = tangent.normalized();
  if (holds_phase) conditions.col(1) = (phase - tangent * (tangent.dot(phase) / tangent.squaredNorm())).normalized();
  return conditions;
}

/// The nodal values of a change of the loop.
std::vector<double> nodes_of(const equations::Collocation& equations, const loop::Loop& at,
                             const loop::Tangent& change) {
  loop::Loop relative = loop::perturbation(at, change);
  for (std::size_t i = 0; i < equations.centre().size(); ++i) relative.modes[i] += equations.centre()[i];
  std::vector<double> values(static_cast<std::size_t>(equations.size()), 0.0);
  equations.from_loop(relative, values.data());
  std::fill(values.begin() + equations.period_at(), values.end(), 0.0);
  values[static_cast<std::size_t>(equations.period_at())] = change.period();
  return values;
}

}  // namespace

Directed expanded(const Probe& probe, const loop::TimeMap& map, int cutoff) {
  const loop::Loop& loop = probe.orbit.loop;
  if (map == loop.time_map)
    return {loop::with_cutoff(loop, cutoff), loop::with_cutoff(probe.tangent, cutoff, loop.dimension)};
  return {loop::with_time_map(loop, map, cutoff), loop::with_time_map(loop, probe.tangent, map, cutoff)};
}

Directed pushed_off(const Setting& setting, const Probe& probe) {
  const loop::Loop& orbit = probe.orbit.loop;
  const loss::Unknowns unknowns{loop::Subspace(orbit.dimension, orbit.cutoff, setting.isotropy()),
                                {loss::Scalar::period()}};
  loop::Loop pushed = orbit;
  for (int k = 0; k <= orbit.cutoff; ++k)
    for (int i = 0; i < orbit.dimension; ++i) {
      const double size = (i % 2 == 0 ? 1.0 : -1.0) / std::pow(1.0 + k, 4);
      pushed.cosine(k, i) += size;
      if (k > 0) pushed.sine(k, i) += size;
    }
  std::vector<double> by = unknowns.difference(orbit, pushed);
  Eigen::Map<Eigen::VectorXd> push(by.data(), unknowns.size());
  const std::vector<double> along = unknowns.coordinates_of(probe.tangent);
  const Eigen::Map<const Eigen::VectorXd> tangent(along.data(), unknowns.size());
  push -= tangent * (tangent.dot(push) / tangent.squaredNorm());
  const loop::Samples change = loop::samples_of(loop::perturbation(orbit, unknowns.tangent_of(by)));
  double largest = 0.0;
  for (const double z : change.states) largest = std::max(largest, std::abs(z));
  push *= setting.branch_options().prediction_error * std::min(1.0, loop::rms_amplitude(orbit)) / largest;
  return {unknowns.moved(orbit, by), probe.tangent};
}

Correction::Correction(const Setting& setting, Directed guess, const loop::Isotropy& isotropy)
    : _setting(setting),
      _guess(std::move(guess)),
      _unknowns{loop::Subspace(_guess.loop.dimension, _guess.loop.cutoff, isotropy), {loss::Scalar::period()}},
      _slice(_unknowns.size(), conditions_at(_guess, _unknowns)) {}

corrector::Result Correction::by(corrector::Method method, double tolerance, int iterations, core::Team* team) const {
  corrector::Options options;
  options.method = method;
  options.tolerance = tolerance;
  // A step under the threshold may be so long by the same rule, of a direction flatter than 1e-4 (corrector::Options).
  options.step_tolerance = std::max(options.step_tolerance, tolerance / flattest);
  options.max_iterations = iterations;
  options.team = team;
  return corrector::correct(*_setting.system(), _guess.loop, _unknowns, _slice, options);
}

std::string obstacle_to_collocation(const Setting& setting) {
  const loop::FundamentalDomain domain = loop::fundamental_domain(setting.system()->structure(), setting.isotropy());
  if (!domain.expresses(setting.isotropy())) return "no domain has the whole isotropy";
  if (!domain.is_square() || !equations::Collocation::applies(*setting.system(), domain))
    return "its equations are not square";
  return {};
}

int cells_for(const Setting& setting, int cutoff) {
  const loop::FundamentalDomain domain = loop::fundamental_domain(setting.system()->structure(), setting.isotropy());
  const int cells = (2 * cutoff + domain.copies()) / domain.copies();
  return std::max(least_cells, (cells + cells_in - 1) / cells_in * cells_in);
}

CollocationResult by_collocation(const Setting& setting, const Directed& guess, const loop::Loop& through, int cells,
                                 double tolerance) {
  const loop::FundamentalDomain domain = loop::fundamental_domain(setting.system()->structure(), setting.isotropy());
  const loop::Loop& base = setting.start().base;
  const std::vector<double> centre(base.modes.begin(), base.modes.begin() + base.dimension);
  equations::Collocation equations(*setting.system(), domain, centre, guess.loop.winding, cells, guess.loop.time_map);
  CollocationResult out;
  out.unknowns = equations.size();
  std::vector<double> u(static_cast<std::size_t>(equations.size()), 0.0);
  equations.from_loop(guess.loop, u.data());
  std::vector<double> reference = u;
  equations.from_loop(through, reference.data());
  std::vector<double> weights = nodes_of(equations, guess.loop, guess.tangent);
  if (equations.borders() > 1) {
    const loss::Unknowns all{loop::Subspace::unrestricted(guess.loop.dimension, guess.loop.cutoff),
                             {loss::Scalar::period()}};
    const std::vector<double> shift =
        nodes_of(equations, guess.loop, all.tangent_of(all.time_shift_direction(guess.loop)));
    weights.insert(weights.end(), shift.begin(), shift.end());
  }
  equations.set_conditions(weights, reference);
  const double amplitude = std::min(1.0, loop::rms_amplitude(guess.loop));
  double size = amplitude;
  for (const double c : centre) size = std::max(size, std::abs(c));
  equations::AndersonSolver::Options options;
  options.tolerance = of_loss_tolerance * tolerance * amplitude;
  options.rounding = std::max(options.tolerance, nodal_rounding * size);
  options.scaled_from = equations.period_at();
  options.border_scale = amplitude;
  equations::OrbitSolver solver;
  try {
    const auto result = solver.solve(equations, u, false, options);
    out.converged = result.converged;
    out.iterations = result.iterations;
    if (!result.converged) out.reason = result.finite ? "no convergence" : "not finite";
  } catch (const core::NumericalError& error) {
    out.reason = error.what();
  }
  out.loop = equations.to_loop(u.data());
  return out;
}

}  // namespace orbweaver::cost
