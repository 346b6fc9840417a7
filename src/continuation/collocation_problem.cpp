#include "collocation_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cell_counts.hpp"
#include "collocation_judgement.hpp"
#include "collocation_metric.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/damped_newton.hpp"
#include "orbweaver/equations/family_direction.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "regrid.hpp"

namespace orbweaver::continuation {

using equations::Collocation;
using equations::Preconditioner;

namespace {

/// Of the corrector's tolerance on sqrt(loss), for the estimated error of the nodal values: the residual multiplies it
/// by the field's Jacobian and 2 pi K/T, and the loss judges afterwards. Not measured.
constexpr double of_loss_tolerance = 1e-2;
/// A change that small, in parts of that tolerance, is good enough even if it shrinks no more. Not measured.
constexpr double good_enough = 0.3;
/// Of the change that would bring the loss to its threshold, and iterations spent on it with a new factor: where fast
/// and slow motions are 50 times apart the changes shrink by 0.9 each (m2 = 1000).
constexpr double sharpened = 0.3;
constexpr int patience = 60;
/// What the harmonics that a new time map leaves out may add to the loss, in parts of its threshold: the rest is
/// for the equations. Not measured.
constexpr double left_to_truncation = 0.3;
/// Where orbits may pass near the zero of a guard, general time maps are looked for from so many cells on, and may be
/// so dense: a passage at the distance r takes r^(3/2) of time (docs/performance.md).
constexpr int guarded_map_cells = 96;
constexpr double guarded_density = 1e-6;
/// Where time scales may be far apart, as beside slow manifolds of what conserves nothing. Van der Pol's orbits need 16
/// times the harmonics at mu = 75 without (docs/mathematics.md, "Time map"). From fewer cells on multipliers cost more
/// than is saved: their segments are long where s is slow.
constexpr int dissipative_map_cells = 768;
/// Keeps quotients by the amplitude finite.
constexpr double least_amplitude = 1e-300;
bool is_affordable(const Collocation& equations) { return equations.size() <= equations::exact_unknowns; }

}  // namespace

std::string CollocationProblem::obstacle(const FamilyOf& family, int largest_cutoff) {
  const loop::FundamentalDomain domain = loop::fundamental_domain(family.system.structure(), family.isotropy);
  if (!domain.expresses(family.isotropy)) return "one part of the loop, repeated, does not have all of their isotropy";
  if (!domain.is_square()) return "the ends of their fundamental domain hold more or fewer conditions than coordinates";
  if (!Collocation::applies(family.system, domain, family.places))
    return "it takes a reversor, a conserved quantity, or a parameter that moves";
  const int coarsest = cell_counts::cutoff_of(domain, cell_counts::least);
  if (coarsest > largest_cutoff)
    return fmt::format("its fewest cells have K = {}, and at most {} is allowed", coarsest, largest_cutoff);
  return {};
}

CollocationProblem::CollocationProblem(const FamilyOf& family, const Options& options, ProblemState& state)
    : PointProblem(family.system, state),
      _system(family.system),
      _domain(loop::fundamental_domain(family.system.structure(), family.isotropy)),
      _isotropy(family.isotropy),
      _centre(family.base.modes.begin(), family.base.modes.begin() + family.base.dimension),
      _winding(family.base.winding),
      _options(options) {}

Resolution CollocationProblem::resolution_for(int cutoff, const loop::TimeMap& map, int largest) const {
  int cells = cell_counts::at_least_for_cutoff(_domain, cutoff);
  while (cells > cell_counts::least && cutoff_of(cells) > largest) cells = cell_counts::previous(cells);
  return {cells, map};
}

std::optional<Resolution> CollocationProblem::next_resolution(int largest) const {
  const int cells = cell_counts::next(resolution().size);
  if (cutoff_of(cells) > largest) return std::nullopt;
  return Resolution{cells, resolution().time_map};
}

/// The Jacobian itself only as far as it can be afforded.
Preconditioner CollocationProblem::preconditioner_of(const Collocation& equations) {
  const Preconditioner wanted = state().preconditioner;
  return wanted == Preconditioner::exact && !is_affordable(equations) ? Preconditioner::fitted_box : wanted;
}

std::shared_ptr<Collocation> CollocationProblem::equations_on(const Resolution& resolution) {
  auto e = std::make_shared<Collocation>(_system, _domain, _centre, _winding, resolution.size, resolution.time_map);
  e->precondition_by(preconditioner_of(*e));
  return e;
}

PointProblem::Transfer CollocationProblem::resolve(const Resolution& to) {
  std::shared_ptr<Collocation> from = std::move(_equations);
  _equations = equations_on(to);
  state().resolution = to;
  state().factor_point.clear();
  return [from = std::move(from), own = _equations](const std::vector<double>& values) {
    return own->resampled(*from, values);
  };
}

Collocation& CollocationProblem::equations() {
  if (!_equations) {
    _equations = equations_on(resolution());
    if (!state().factor_point.empty()) {
      _equations->set_conditions(state().factor_conditions, state().factor_point);
      _equations->factor(state().factor_point.data());
    }
  }
  return *_equations;
}

std::vector<double> CollocationProblem::from_loop(const loop::Loop& loop) {
  std::vector<double> values(static_cast<std::size_t>(equations().size()), 0.0);
  equations().from_loop(loop, values.data());
  return values;
}

std::vector<double> CollocationProblem::from_change(const loop::Loop& change) {
  const Collocation& e = equations();
  std::vector<double> values(static_cast<std::size_t>(e.size()), 0.0);
  loop::Loop relative = change;
  for (std::size_t i = 0; i < e.centre().size(); ++i) relative.modes[i] += e.centre()[i];
  e.from_loop(relative, values.data());
  for (int q = 0; q < e.borders(); ++q) values[static_cast<std::size_t>(e.period_at() + q)] = 0.0;
  return values;
}

loop::Tangent CollocationProblem::change_of(const std::vector<double>& direction, const loop::Loop& at) {
  const Collocation& own = equations();
  const loop::StaggeredGrid* grid = &own.grid();
  std::vector<double> values = direction;
  std::optional<Collocation> before;
  if (!(resolution().time_map == at.time_map)) {  // after a change for an orbit that was not accepted
    const std::vector<double> no_winding(own.winding().size(), 0.0);
    const int cells = cell_counts::at_least_for_cutoff(_domain, at.cutoff);
    before.emplace(_system, _domain, own.centre(), no_winding, cells, at.time_map);
    values = before->resampled(own, values);
    grid = &before->grid();
  }
  loop::Tangent out;
  out.modes.resize((2 * static_cast<std::size_t>(grid->cutoff()) + 1) * static_cast<std::size_t>(own.dimension()));
  grid->to_modes(values.data(), out.modes.data());
  out = loop::with_cutoff(std::move(out), at.cutoff, at.dimension);
  const auto scalars = values.end() - own.borders();
  out.scalars.assign(scalars, scalars + 1 + static_cast<std::ptrdiff_t>(_system.family_scalars().free.size()));
  return out;
}

double CollocationProblem::distance(const std::vector<double>& a, const std::vector<double>& b) {
  return equations().distance(a.data(), b.data());
}

double CollocationProblem::change_at_start(const std::vector<double>& change) {
  const Collocation& e = equations();
  std::vector<double> z(static_cast<std::size_t>(e.dimension() * e.grid().stride()));
  std::vector<double> slope(z.size());
  e.grid().at_nodes(change.data(), z.data(), slope.data());
  double square = 0.0;
  for (int i = 0; i < e.dimension(); ++i) square += std::pow(z[static_cast<std::size_t>(i * e.grid().stride())], 2);
  return std::sqrt(square);
}

double CollocationProblem::action(const Trial& trial) { return equations().action(trial.values.data()); }

std::vector<double> CollocationProblem::direction_at(const std::vector<double>& orbit, const Prediction& near) {
  const std::shared_ptr<Collocation> e = equations_on(resolution());  // of its own: the factor at hand stays
  e->set_conditions(conditions_at(near), orbit);
  try {
    return equations::family_direction(*e, orbit);
  } catch (const core::NumericalError&) {
    return near.tangent;
  }
}

std::array<std::vector<double>, 2> CollocationProblem::surface_at(const std::vector<double>& orbit,
                                                                  const Prediction& near) {
  const std::shared_ptr<Collocation> e = equations_on(resolution());
  e->set_conditions(conditions_at(near), orbit);
  return {equations::family_direction(*e, orbit, 0), equations::family_direction(*e, orbit, e->borders() - 1)};
}

std::vector<double> CollocationProblem::conditions_at(const Prediction& prediction) {
  return step_conditions(equations(), prediction, period_unit(prediction.values[scalars_at()]));
}

void CollocationProblem::settle(Prediction& prediction, const std::vector<double>& last) {
  const Collocation& e = equations();
  if (_system.family_scalars().hold == systems::FamilyScalars::Hold::period) {
    prediction.values[scalars_at()] = last[scalars_at()];
    prediction.tangent[scalars_at()] = 0.0;
  }
  if (_domain.reversor) return;
  for (std::size_t p = 0; p < e.scalars().size(); ++p)
    if (e.scalars()[p].kind == loss::Scalar::Kind::unfolding)
      prediction.values[scalars_at() + p] = prediction.tangent[scalars_at() + p] = 0.0;
  take_out_shift(e, prediction, last);
}

double CollocationProblem::product(const std::vector<double>& a, const std::vector<double>& b,
                                   const std::vector<double>& c, const std::vector<double>& d) {
  return step_product(equations(), a, b, c, d, period_unit(b[scalars_at()]));
}

bool CollocationProblem::inverted(const Trial& trial, const std::vector<double>& last) {
  return is_upside_down(equations(), last, trial.values);
}

double CollocationProblem::bounded_amplitude() { return std::min(1.0, std::max(state().amplitude, least_amplitude)); }

double CollocationProblem::rounding_of_nodes() {
  double size = bounded_amplitude();
  for (const double c : equations().centre()) size = std::max(size, std::abs(c));
  return nodal_rounding * size;
}

equations::AndersonSolver::Options CollocationProblem::solver_options() {
  const Collocation& e = equations();
  equations::AndersonSolver::Options solver;
  // At a small amplitude A the equations see a change of T only A times.
  const double amplitude = bounded_amplitude();
  solver.tolerance = of_loss_tolerance * std::min(_options.corrector.tolerance, of_the_way) * amplitude;
  solver.rounding = std::max(good_enough * solver.tolerance, rounding_of_nodes());
  solver.scaled_from = e.period_at();
  solver.border_scale = amplitude;
  return solver;
}

Trial CollocationProblem::solve(Prediction prediction, const std::vector<double>& conditions) {
  Collocation& e = equations();
  e.precondition_by(preconditioner_of(e));
  e.keep_symmetries(prediction.values.data());
  e.set_conditions(conditions, prediction.values);
  Trial trial;
  trial.order = prediction.order;
  trial.values = std::move(prediction.values);
  if (!(trial.values[static_cast<std::size_t>(e.period_at())] > 0.0)) {
    trial.reason = "the predicted period is not positive";
    return trial;
  }
  const std::vector<double> predicted = trial.values;
  double last_change = 0.0;
  bool has_new_factor = false;
  try {
    auto result = _solver.solve(e, trial.values, !state().factor_point.empty(), solver_options());
    if (!result.converged && _options.base_is_far) {
      trial.values = predicted;
      equations::approach(e, trial.values, e.period_at(), bounded_amplitude());
      result = _solver.solve(e, trial.values, false, solver_options());
    }
    trial.iterations = result.iterations;
    trial.prediction_error = result.first_change;
    trial.converged = result.converged;
    last_change = result.last_change;
    trial.stagnated = result.stagnated;
    has_new_factor = result.factored;
    if (result.factored) {
      state().factor_point = std::move(result.factor_point);
      state().factor_conditions = conditions;
    }
    if (!result.converged) {
      // Where the linearised equations are singular to rounding a solve goes astray among points at all of which they
      // hold.
      if (result.finite && holds_to_rounding(e, trial.values)) trial.known_to = last_change;
      state().factor_point.clear();
      trial.reason = result.finite
                         ? fmt::format("no convergence in {} iteration{}, the last change {:.2g}", result.iterations,
                                       result.iterations == 1 ? "" : "s", result.last_change)
                         : not_finite_at(e, trial.values, predicted, beyond_numbers);
    }
  } catch (const core::NumericalError& error) {
    state().factor_point.clear();
    trial.converged = false;
    trial.reason = not_finite_at(e, trial.values, predicted, error.what());
  }
  if (trial.converged) judge(e, _winding, _options, trial);
  if (trial.converged && rests_aside(trial)) solve_by_gmres(trial, has_new_factor, predicted, conditions);
  if (trial.converged && may_be_sharper(trial)) {  // the loss's threshold may lie far above rounding
    sharpen(trial, last_change, conditions);
    // Beside a fast motion the box scheme's error is what patience is for.
    if (!e.has_cells_to_fit() && rests_aside(trial)) solve_by_gmres(trial, true, predicted, conditions);
  }
  if (state().preconditioner == Preconditioner::exact && !is_affordable(e) && (!trial.converged || trial.unsolved)) {
    trial.converged = false;
    trial.under_resolved = true;  // once the cells resolve the fast motion they precondition it
  }
  return trial;
}

/// Whether the box scheme's error may be all that is seen along some direction of an orbit where the solver came to
/// rest.
bool CollocationProblem::rests_aside(const Trial& trial) {
  if (!trial.stagnated || !trial.is_orbit || state().preconditioner == Preconditioner::exact) return false;
  return !equations().is_at_rounding(trial.values.data());
}

/// Anew by GMRES, and so the branch from here on. From the prediction: where the solver came to rest the equations may
/// be flatter than at the orbit, and Newton's steps lead away. What does not solve them either is no orbit to begin
/// with; on a branch that GMRES has begun it is as far as rounding lets them be solved.
void CollocationProblem::solve_by_gmres(Trial& trial, bool has_new_factor, const std::vector<double>& predicted,
                                        const std::vector<double>& conditions) {
  Collocation& e = equations();
  const bool is_first = state().preconditioner != Preconditioner::krylov;
  if (!is_first && has_new_factor) return;
  Trial from = trial;
  from.values = predicted;
  e.precondition_by(Preconditioner::krylov);
  std::optional<Trial> other = solved_anew(solver_options(), conditions, std::move(from));
  if (other && other->is_orbit && !rests_aside(*other)) {
    trial = std::move(*other);
    state().preconditioner = Preconditioner::krylov;
    return;
  }
  e.precondition_by(preconditioner_of(e));
  state().factor_point.clear();
  if (!is_first) return;
  trial.converged = trial.is_orbit = trial.at_rounding = false;
  trial.is_refused = true;
  trial.reason = fmt::format("the corrector comes to rest at a residual of {:.2g}", trial.asked_rms);
}

/// Harmonics that the solver has left wrong say nothing of the resolution: the equations must hold first.
bool CollocationProblem::may_be_sharper(Trial& trial) {
  if (trial.lost_in_rounding) return false;
  return trial.unsolved || ((!trial.is_orbit || trial.at_rounding || trial.is_beside_the_way) && resolved(trial));
}

/// Solves on where the loss is above its threshold and harmonics would not help: the solver's own tolerance foresees a
/// field whose Jacobian is of order 1, and its look for stagnation a preconditioner that resolves the fastest motion.
/// Where not even patience helps, the linear systems are solved as they are.
void CollocationProblem::sharpen(Trial& trial, double last_change, const std::vector<double>& conditions) {
  Collocation& e = equations();
  equations::AndersonSolver::Options options = solver_options();
  const double excess = trial.unsolved || trial.is_beside_the_way ? trial.asked_rms : trial.loss_rms;
  const double wanted = trial.is_beside_the_way ? trial.threshold_of_the_way : trial.threshold;
  options.tolerance = sharpened * wanted / excess * std::max(last_change, options.tolerance);
  options.rounding = std::max(good_enough * options.tolerance, rounding_of_nodes());
  options.stagnation = 0.0;
  options.fresh_iterations = patience;
  (void)sharpen_with(options, conditions, trial);
  const bool failed = trial.unsolved || ((!trial.is_orbit || trial.is_beside_the_way) && resolved(trial));
  if (!failed || !is_affordable(e) || state().preconditioner == Preconditioner::exact) return;
  e.precondition_by(Preconditioner::exact);
  const bool better = sharpen_with(solver_options(), conditions, trial);
  if (better && trial.is_orbit)
    state().preconditioner = Preconditioner::exact;
  else
    state().factor_point.clear();
}

/// From the trial's values with a new factor, and judged; none where that meets what is not finite.
std::optional<Trial> CollocationProblem::solved_anew(const equations::AndersonSolver::Options& options,
                                                     const std::vector<double>& conditions, Trial trial) {
  try {
    auto result = _solver.solve(equations(), trial.values, false, options);
    trial.stagnated = result.stagnated || !result.converged;
    state().factor_point = std::move(result.factor_point);
    state().factor_conditions = conditions;
    trial.iterations += result.iterations;
  } catch (const core::NumericalError&) {
    state().factor_point.clear();
    return std::nullopt;
  }
  trial.is_orbit = trial.at_rounding = trial.truncated = trial.unsolved = trial.to_rounding = false;
  trial.lost_in_rounding = false;
  judge(equations(), _winding, _options, trial);
  return trial;
}

/// False where the trial is no better than it was.
bool CollocationProblem::sharpen_with(const equations::AndersonSolver::Options& options,
                                      const std::vector<double>& conditions, Trial& trial) {
  std::optional<Trial> other = solved_anew(options, conditions, trial);
  if (!other) return false;
  const bool asks = trial.unsolved || trial.is_beside_the_way;
  const bool better = asks ? other->asked_rms < trial.asked_rms : other->loss_rms < trial.loss_rms;
  if (!other->converged || !better) return false;
  other->stagnated = other->stagnated || trial.stagnated;  // the tolerance of before decides
  trial = std::move(*other);
  return true;
}

/// At a small amplitude the period is known to eps / amplitude only: it must not decide how far a step went.
double CollocationProblem::period_unit(double period) { return period / std::min(1.0, state().amplitude); }

bool CollocationProblem::resolved(Trial& trial) { return is_resolved(equations(), _options, trial); }

std::optional<Resolution> CollocationProblem::finer(const Trial& trial, const std::vector<double>& settled,
                                                    bool may_fit) {
  if (_options.fit_time_map && may_fit)
    if (std::optional<Resolution> general = remapped(trial, settled)) return general;
  return finer_resolution(equations(), trial.values, tail_limit(trial.amplitude, trial.size, _options),
                          _options.cutoff_to, _options.fit_time_map);
}

/// Fewer cells where the orbit needs far fewer harmonics than it has, or would under another time map.
std::optional<Resolution> CollocationProblem::coarser(const Trial& accepted, const loop::Loop& loop, bool may_fit) {
  if (_options.fit_time_map && may_fit)
    if (std::optional<Resolution> other = remapped(accepted, accepted.values)) return other;
  const std::optional<int> fewer =
      coarser_cells(loop, _domain, tail_limit(accepted.amplitude, accepted.size, _options), _options.cutoff_from);
  if (!fewer || *fewer >= resolution().size) return std::nullopt;
  return Resolution{*fewer, resolution().time_map};
}

/// A general time map for a settled point where that pays, to the accuracy of `of`, a trial near it.
std::optional<Resolution> CollocationProblem::remapped(const Trial& of, const std::vector<double>& settled) {
  const Collocation& e = equations();
  // What the loss allows the first harmonic that is left out, at the present cutoff.
  const double period = settled[scalars_at()];
  const double allowed = left_to_truncation * of.threshold * period / (2.0 * std::numbers::pi * e.grid().cutoff());
  const double rounding = mode_rounding * of.size;
  const bool guarded = !_system.structure().guards.empty();
  int from_cells = _options.general_map_cells;
  if (guarded) from_cells = std::min(from_cells, guarded_map_cells);
  if (_system.structure().dissipative) from_cells = std::min(from_cells, dissipative_map_cells);
  if (e.cells() < from_cells) return std::nullopt;
  return general_resolution(e, settled, _isotropy,
                            std::max(std::min(tail_limit(of.amplitude, of.size, _options), allowed), rounding),
                            _options.cutoff_from, guarded ? guarded_density : loop::least_density);
}

}  // namespace orbweaver::continuation
