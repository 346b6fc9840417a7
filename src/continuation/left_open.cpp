#include "orbweaver/continuation/left_open.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "cell_counts.hpp"
#include "collocation_metric.hpp"
#include "collocation_problem.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::continuation {

using equations::Collocation;

namespace {

/// Of the amplitude: a change far above rounding, whose square is far below it.
constexpr double seen = 1e-7;

/// Signs that follow no pattern of the equations'.
std::vector<double> random_signs(std::size_t count) {
  std::vector<double> signs(count);
  std::minstd_rand generator;
  for (double& sign : signs) sign = generator() % 2 == 0 ? 1.0 : -1.0;
  return signs;
}

/// A residual in dz/dt of this size everywhere.
std::vector<double> residual_of(const Collocation& e, double period, double size) {
  std::vector<double> residual(static_cast<std::size_t>(e.size()), 0.0);
  const double scale = e.grid().spacing() * period / (2.0 * std::numbers::pi);
  const std::vector<double> signs = random_signs(residual.size());
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j < e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      residual[n] = signs[n] * scale * size;
    }
  return residual;
}

/// What rounding leaves of the residual in dz/dt: of its differences by what moves about the centre, whose change the
/// unknowns are, and of the field by the state, which about a far origin is much larger. No less than is left.
double residual_left(const Collocation& e, const Collocation::Quality& quality, double period) {
  const double jacobian = e.field_jacobian_rms();
  const double moving =
      std::max(corrector::rounding_floor(e.grid().cutoff(), period, quality.amplitude, quality.speed_rms, jacobian),
               nodal_rounding * quality.amplitude * jacobian);
  const double expected = std::max(moving, corrector::state_rounding(quality.size, jacobian));
  return std::max(expected, std::min(quality.asked, rounding_floor(e, quality, period)));
}

/// Solutions of the linearised equations, one with residuals of 1 in dz/dt and one that only the first condition sees.
struct Solutions {
  std::vector<double> across;
  std::vector<double> along;
};

/// By GMRES where it gets there, which takes a hundredth of the time of factors, and by those else; none where there
/// are too many unknowns for them.
std::optional<Solutions> solutions(Collocation& e, const std::vector<double>& values, double period) {
  using equations::Preconditioner;
  for (const Preconditioner way : {Preconditioner::krylov, Preconditioner::exact}) {
    if (way == Preconditioner::exact && e.size() > equations::exact_unknowns) break;
    e.precondition_by(way);
    e.factor(values.data());
    // GMRES stops at what rounding leaves of a residual: these are as much larger as to be far from that.
    Solutions found{residual_of(e, period, 1.0 / nodal_rounding), std::vector<double>(values.size(), 0.0)};
    found.along[static_cast<std::size_t>(e.period_at())] = 1.0 / nodal_rounding;
    bool are_solved = true;
    for (std::vector<double>* solution : {&found.across, &found.along}) {
      e.precondition(solution->data());
      are_solved = are_solved && e.is_solved();
      for (double& number : *solution) number *= nodal_rounding;
    }
    if (are_solved) return found;
  }
  return std::nullopt;
}

}  // namespace

LeftOpen left_open_by_rounding(const systems::System& system, const loop::Loop& orbit, const loop::Isotropy& isotropy) {
  if (!CollocationProblem::obstacle({system, orbit, isotropy}, orbit.cutoff).empty()) return {};
  const loop::FundamentalDomain domain = loop::fundamental_domain(system.structure(), isotropy);
  const std::vector<double> centre(orbit.modes.begin(), orbit.modes.begin() + orbit.dimension);
  Collocation e(system, domain, centre, orbit.winding, cell_counts::at_least_for_cutoff(domain, orbit.cutoff),
                orbit.time_map);
  std::vector<double> values(static_cast<std::size_t>(e.size()), 0.0);
  e.from_loop(orbit, values.data());
  try {
    // Which place along the family is held does not matter.
    e.set_conditions(step_conditions(e, {values, random_signs(values.size()), 1}, orbit.period), values);
    std::optional<Solutions> found = solutions(e, values, orbit.period);
    if (!found) return {};
    std::vector<double>& moved = found->across;
    const std::vector<double>& direction = found->along;
    const double left = residual_left(e, e.quality(values.data()), orbit.period);
    for (double& number : moved) number *= left;
    const std::vector<double> none(values.size(), 0.0);
    const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
      return step_product(e, a, none, b, none, orbit.period);
    };
    const double part = product(moved, direction) / product(direction, direction);
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] -= part * direction[n];
    LeftOpen open;
    open.across = std::sqrt(product(moved, moved));
    open.period = std::abs(moved[static_cast<std::size_t>(e.period_at())]);
    if (!std::isfinite(open.across)) return {};
    const auto loop_at = [&](double share) {
      std::vector<double> there = values;
      for (std::size_t n = 0; n < there.size(); ++n) there[n] += share * moved[n];
      return e.to_loop(there.data());
    };
    const loop::Loop there = loop_at(1.0);
    if (open.across > 0.0) {
      open.times = open.across / (seen * loop::rms_amplitude(orbit));
      open.beside = loop_at(1.0 / open.times);
    }
    if (system.structure().conservative()) open.energy = std::abs(energy_of(system, there) - energy_of(system, orbit));
    if (!orbit.parameters.empty()) open.parameter = std::abs(there.parameters.front() - orbit.parameters.front());
    return open;
  } catch (const core::NumericalError&) {
    return {};
  }
}

}  // namespace orbweaver::continuation
