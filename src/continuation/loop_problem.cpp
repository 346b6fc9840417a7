#include "loop_problem.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "held_energy.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loss/slice.hpp"

namespace orbweaver::continuation {

namespace {

/// Of the bound on the tail, for a smaller cutoff: at the bound itself cutoffs would come and go. The next smaller
/// one has 0.7 to 0.8 of the harmonics. Not measured.
constexpr double dropped = 0.01;

std::vector<double> as_change(loop::Tangent tangent) {
  tangent.modes.insert(tangent.modes.end(), tangent.scalars.begin(), tangent.scalars.end());
  return std::move(tangent.modes);
}

}  // namespace

LoopProblem::LoopProblem(const FamilyOf& family, const Options& options, ProblemState& state)
    : PointProblem(family.system, state),
      _system(family.system),
      _base(family.base),
      _isotropy(family.isotropy),
      _options(options) {}

Resolution LoopProblem::resolution_for(int cutoff, const loop::TimeMap& map, int largest) const {
  return {std::min(loop::allowed_cutoff_at_least(cutoff), largest), map};
}

std::optional<Resolution> LoopProblem::next_resolution(int largest) const {
  const int cutoff = loop::next_cutoff(resolution().size);
  if (cutoff > largest) return std::nullopt;
  return Resolution{cutoff, resolution().time_map};
}

std::optional<Resolution> LoopProblem::finer(const Trial&, const std::vector<double>&, bool) {
  return next_resolution(_options.cutoff_to);
}

/// Harmonics that would stay negligible under a smaller cutoff are dropped before the next step.
std::optional<Resolution> LoopProblem::coarser(const Trial& accepted, const loop::Loop& loop, bool) {
  const int smaller = loop::previous_cutoff(loop.cutoff);
  if (smaller < _options.cutoff_from || smaller >= loop.cutoff) return std::nullopt;
  const loop::Loop shorter = loop::with_cutoff(loop, smaller);
  const double negligible = dropped * tail_limit(accepted.amplitude, accepted.size, _options);
  if (loop::mean_distance(loop, shorter) >= negligible || loop::tail(shorter) >= negligible) return std::nullopt;
  return Resolution{smaller, resolution().time_map};
}

PointProblem::Transfer LoopProblem::resolve(const Resolution& to) {
  state().resolution = to;
  const std::size_t modes = scalars_at();
  const std::size_t scalars = this->scalars();
  return [=](const std::vector<double>& values) {
    std::vector<double> out(values.begin(), values.end() - static_cast<std::ptrdiff_t>(scalars));
    out.resize(modes, 0.0);
    out.insert(out.end(), values.end() - static_cast<std::ptrdiff_t>(scalars), values.end());
    return out;
  };
}

std::size_t LoopProblem::scalars_at() {
  return (2 * static_cast<std::size_t>(resolution().size) + 1) * static_cast<std::size_t>(_base.dimension);
}

loop::Loop LoopProblem::to_loop(const std::vector<double>& values) const {
  loop::Loop loop = _base;
  loop.cutoff = resolution().size;
  loop.time_map = resolution().time_map;
  const auto modes = values.end() - static_cast<std::ptrdiff_t>(scalars());
  loop.modes.assign(values.begin(), modes);
  loop.period = *modes;
  loop.parameters.assign(modes + 1, values.end());
  return loop;
}

std::vector<double> LoopProblem::to_values(const loop::Loop& loop) const {
  std::vector<double> values = loop.modes;
  values.push_back(loop.period);
  values.insert(values.end(), loop.parameters.begin(), loop.parameters.end());
  return values;
}

loop::Tangent LoopProblem::as_tangent(std::span<const double> change) const {
  const auto modes = change.end() - static_cast<std::ptrdiff_t>(scalars());
  return {{change.begin(), modes}, {modes, change.end()}};
}

std::vector<double> LoopProblem::from_loop(const loop::Loop& loop) {
  return to_values(loop::with_cutoff(loop, resolution().size));
}

std::vector<double> LoopProblem::from_change(const loop::Loop& change) {
  std::vector<double> values = from_loop(change);
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(scalars_at()), values.end(), 0.0);
  return values;
}

loop::Tangent LoopProblem::change_of(const std::vector<double>& direction, const loop::Loop& at) {
  return loop::with_cutoff(as_tangent(direction), at.cutoff, at.dimension);
}

double LoopProblem::product(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                            const std::vector<double>& d) {
  double sum = 0.0;
  for (std::size_t n = 0; n < scalars_at(); ++n) {
    const double mean = n < static_cast<std::size_t>(_base.dimension) ? 1.0 : 0.5;  // of 1, and of cos^2 and sin^2
    sum += mean * (a[n] - b[n]) * (c[n] - d[n]);
  }
  // At a small amplitude the period is known to eps / amplitude only: it must not decide how far a step went.
  const std::size_t period = scalars_at();
  const double unit = b[period] / std::min(1.0, state().amplitude);
  sum += (a[period] - b[period]) * (c[period] - d[period]) / (unit * unit);
  for (std::size_t n = period + 1; n < a.size(); ++n) sum += (a[n] - b[n]) * (c[n] - d[n]);
  return sum;
}

double LoopProblem::condition_product(const std::vector<double>& a, const std::vector<double>& b,
                                      const std::vector<double>& c, const std::vector<double>& d) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (c[n] - d[n]);
  return sum;
}

double LoopProblem::distance(const std::vector<double>& a, const std::vector<double>& b) {
  return arclength_between(to_loop(b), to_loop(a));
}

double LoopProblem::change_at_start(const std::vector<double>& change) {
  return loop::change_at_start(loop::with_cutoff(_base, resolution().size), as_tangent(change));
}

bool LoopProblem::inverted(const Trial& trial, const std::vector<double>& last) {
  double product = 0.0;
  for (auto n = static_cast<std::size_t>(_base.dimension); n < scalars_at(); ++n) product += trial.values[n] * last[n];
  return product < 0.0;
}

double LoopProblem::action(const Trial& trial) { return action_of(_system, trial.loop); }

const loss::Unknowns& LoopProblem::unknowns() {
  if (!_unknowns || _unknowns->subspace.cutoff() != resolution().size) {
    std::vector<loss::Scalar> scalars{loss::Scalar::period()};
    for (const std::string& name : _system.family_scalars().free) scalars.push_back(loss::Scalar::of_parameter(name));
    _unknowns.emplace(
        loss::Unknowns{loop::Subspace(_base.dimension, resolution().size, _isotropy), std::move(scalars)});
  }
  return *_unknowns;
}

std::vector<double> LoopProblem::time_shift(const std::vector<double>& values) {
  const std::vector<double> shift = time_shift_condition(to_loop(values), unknowns());
  return shift.empty() ? shift : as_change(unknowns().tangent_of(shift));
}

void LoopProblem::settle(Prediction& prediction, const std::vector<double>& last) {
  if (_system.family_scalars().hold == systems::FamilyScalars::Hold::period) {
    prediction.values[scalars_at()] = last[scalars_at()];
    prediction.tangent[scalars_at()] = 0.0;
  }
  const std::vector<double> shift = time_shift(last);
  if (shift.empty()) return;
  double moved = 0.0;
  double turned = 0.0;
  for (std::size_t n = 0; n < shift.size(); ++n) {
    moved += shift[n] * (prediction.values[n] - last[n]);
    turned += shift[n] * prediction.tangent[n];
  }
  for (std::size_t n = 0; n < shift.size(); ++n) {
    prediction.values[n] -= moved * shift[n];
    prediction.tangent[n] -= turned * shift[n];
  }
}

std::vector<double> LoopProblem::conditions_at(const Prediction& prediction) {
  std::vector<double> conditions = prediction.tangent;
  double square = 0.0;
  for (const double v : conditions) square += v * v;
  for (double& v : conditions) v /= std::sqrt(square);
  const std::vector<double> held = held_condition(prediction);
  conditions.insert(conditions.end(), held.begin(), held.end());
  const std::vector<double> shift = time_shift(prediction.values);
  conditions.insert(conditions.end(), shift.begin(), shift.end());
  return conditions;
}

std::vector<double> LoopProblem::held_condition(const Prediction& prediction) {
  using Hold = systems::FamilyScalars::Hold;
  const Hold hold = _system.family_scalars().hold;
  if (hold == Hold::nothing) return {};
  std::vector<double> row(prediction.values.size(), 0.0);
  if (hold == Hold::period) {
    row[scalars_at()] = 1.0;
    return row;
  }
  // The derivative of the energy at s = 0, where it is taken, by every mode.
  const loop::Loop loop = to_loop(prediction.values);
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> gradient(d);
  loop::system_at(_system, loop)->conserved_gradient(0, loop::state_at(loop, 0.0), gradient);
  for (std::size_t k = 0; k <= static_cast<std::size_t>(loop.cutoff); ++k)
    for (std::size_t i = 0; i < d; ++i) row[(k == 0 ? 0 : 2 * k - 1) * d + i] = gradient[i];
  for (std::size_t n = 0; n < loop.parameters.size(); ++n)
    row[scalars_at() + 1 + n] = energy_by_parameter(_system, loop, n);
  return row;
}

Eigen::MatrixXd LoopProblem::columns(const std::vector<double>& conditions) {
  const std::size_t row = scalars_at() + scalars();
  Eigen::MatrixXd out(unknowns().size(), static_cast<Eigen::Index>(conditions.size() / row));
  for (Eigen::Index q = 0; q < out.cols(); ++q) {
    const std::vector<double> column =
        unknowns().coordinates_of(as_tangent(std::span(conditions).subspan(static_cast<std::size_t>(q) * row, row)));
    out.col(q) = Eigen::Map<const Eigen::VectorXd>(column.data(), out.rows()).normalized();
  }
  return out;
}

/// Without what rounding has left beside the isotropy: extrapolations would multiply it, and no correction sees it.
loop::Loop LoopProblem::with_symmetries(const loop::Loop& loop) {
  const loop::Subspace& subspace = unknowns().subspace;
  const loop::Loop base = loop::with_cutoff(_base, loop.cutoff);
  std::vector<double> change(loop.modes.size());
  for (std::size_t n = 0; n < change.size(); ++n) change[n] = loop.modes[n] - base.modes[n];
  std::vector<double> coordinates(static_cast<std::size_t>(subspace.size()));
  subspace.project(change, coordinates);
  loop::Loop out = loop;
  out.modes = base.modes;
  subspace.add_to(coordinates, out.modes);
  return out;
}

Trial LoopProblem::solve(Prediction prediction, const std::vector<double>& conditions) {
  const loop::Loop guess = with_symmetries(to_loop(prediction.values));
  corrector::Result result = corrector::correct(
      _system, guess, unknowns(), loss::Slice(unknowns().size(), columns(conditions)), _options.corrector);
  Trial trial;
  trial.order = prediction.order;
  trial.converged = trial.is_orbit = result.converged();
  trial.at_rounding = result.at_rounding;
  trial.lost_in_rounding = result.outcome == corrector::Outcome::lost_in_rounding;
  trial.under_resolved = result.outcome == corrector::Outcome::under_resolved;
  trial.reason = std::move(result.detail);
  trial.values = to_values(result.loop);
  trial.iterations = result.iterations;
  trial.loss_rms = result.loss_rms;
  trial.threshold = result.threshold;
  trial.tolerance_met = result.tolerance_met;
  trial.loop = std::move(result.loop);
  if (!trial.converged) return trial;
  trial.amplitude = loop::rms_amplitude(trial.loop);
  trial.size = extent_of(trial.loop.winding, loop::rms_size(trial.loop));
  trial.prediction_error =
      std::hypot(loop::mean_distance(guess, trial.loop), trial.amplitude * (trial.loop.period / guess.period - 1.0));
  return trial;
}

bool LoopProblem::resolved(Trial& trial) {
  return loop::tail(trial.loop) <= tail_limit(trial.amplitude, trial.size, _options);
}

std::vector<double> LoopProblem::direction_at(const std::vector<double>& orbit, const Prediction& near) {
  const Eigen::MatrixXd conditions = columns(conditions_at({orbit, near.tangent, 1}));
  // A tangent does not shift the phase.
  Eigen::VectorXd normal = conditions.col(0);
  for (Eigen::Index q = 1; q < conditions.cols(); ++q) normal -= conditions.col(q).dot(normal) * conditions.col(q);
  normal.normalize();
  const corrector::Result result = corrector::correct(
      _system, to_loop(orbit), unknowns(), loss::Slice(unknowns().size(), conditions), _options.corrector, normal);
  if (!result.converged()) return near.tangent;
  const Eigen::VectorXd& flat = result.flat_direction.value();
  return as_change(unknowns().tangent_of(std::span(flat.data(), static_cast<std::size_t>(flat.size()))));
}

std::vector<double> time_shift_condition(const loop::Loop& loop, const loss::Unknowns& unknowns) {
  std::vector<double> shift = unknowns.time_shift_direction(loop);
  double square = 0.0;
  for (const double v : shift) square += v * v;
  const double length = std::sqrt(square);
  if (length <= loss::Unknowns::least_time_shift * loop::rms_amplitude(loop)) return {};
  for (double& v : shift) v /= length;
  return shift;
}

}  // namespace orbweaver::continuation
