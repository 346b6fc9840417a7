#include "orbweaver/continuation/left_open.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "cell_counts.hpp"
#include "collocation_metric.hpp"
#include "collocation_problem.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::continuation {

using equations::Collocation;

namespace {

/// Signs that follow no pattern of the equations'.
std::vector<double> random_signs(std::size_t count) {
  std::vector<double> signs(count);
  std::minstd_rand generator;
  for (double& sign : signs) sign = generator() % 2 == 0 ? 1.0 : -1.0;
  return signs;
}

/// The solution of the linearised equations whose residual in dz/dt is `size` everywhere.
std::vector<double> moved_by(const Collocation& e, double period, double size) {
  std::vector<double> moved(static_cast<std::size_t>(e.size()), 0.0);
  const double scale = e.grid().spacing() * period / (2.0 * std::numbers::pi);
  const std::vector<double> signs = random_signs(moved.size());
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j < e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      moved[n] = signs[n] * scale * size;
    }
  e.precondition(moved.data());
  return moved;
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

/// Along the family: what only the first condition sees.
std::vector<double> along(const Collocation& e) {
  std::vector<double> direction(static_cast<std::size_t>(e.size()), 0.0);
  direction[static_cast<std::size_t>(e.period_at())] = 1.0;
  e.precondition(direction.data());
  return direction;
}

}  // namespace

LeftOpen left_open_by_rounding(const systems::System& system, const loop::Loop& orbit, const loop::Isotropy& isotropy) {
  if (!CollocationProblem::obstacle({system, orbit, isotropy}, orbit.cutoff).empty()) return {};
  const loop::FundamentalDomain domain = loop::fundamental_domain(system.structure(), isotropy);
  const std::vector<double> centre(orbit.modes.begin(), orbit.modes.begin() + orbit.dimension);
  Collocation e(system, domain, centre, orbit.winding, cell_counts::at_least_for_cutoff(domain, orbit.cutoff),
                orbit.time_map);
  if (e.size() > equations::exact_unknowns) return {};
  std::vector<double> values(static_cast<std::size_t>(e.size()), 0.0);
  e.from_loop(orbit, values.data());
  try {
    // Which place along the family is held does not matter.
    e.set_conditions(step_conditions(e, {values, random_signs(values.size()), 1}, orbit.period), values);
    e.precondition_by(equations::Preconditioner::exact);
    e.factor(values.data());
    std::vector<double> moved = moved_by(e, orbit.period, residual_left(e, e.quality(values.data()), orbit.period));
    const std::vector<double> direction = along(e);
    const std::vector<double> none(values.size(), 0.0);
    const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
      return step_product(e, a, none, b, none, orbit.period);
    };
    const double part = product(moved, direction) / product(direction, direction);
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] -= part * direction[n];
    LeftOpen open{.across = std::sqrt(product(moved, moved)),
                  .period = std::abs(moved[static_cast<std::size_t>(e.period_at())])};
    if (!std::isfinite(open.across)) return {};
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += values[n];
    const loop::Loop there = e.to_loop(moved.data());
    if (system.structure().conservative()) open.energy = std::abs(energy_of(system, there) - energy_of(system, orbit));
    if (!orbit.parameters.empty()) open.parameter = std::abs(there.parameters.front() - orbit.parameters.front());
    return open;
  } catch (const core::NumericalError&) {
    return {};
  }
}

}  // namespace orbweaver::continuation
