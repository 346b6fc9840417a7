#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "branch_implementation.hpp"
#include "cell_counts.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "point_corrector.hpp"
#include "predictor.hpp"
#include "regrid.hpp"

namespace orbweaver::continuation {

namespace {

using equations::Collocation;

/// Iterations of the last correction above which the preconditioner is built anew (docs/performance.md: 4 to 9 cost the same).
constexpr int renew_after = 7;

/// Orbits from one look for another general time map to the next.
constexpr int refit_every = 32;

class CollocationBranch final : public Branch::Implementation {
 public:
  CollocationBranch(std::shared_ptr<const systems::System> of, const Start& from, const Options& with,
                    loop::FundamentalDomain domain)
      : Implementation(std::move(of), from, with), _points(*system, start, std::move(domain), options, frontier) {}

 private:
  [[nodiscard]] TraceState& state() { return frontier.trace; }
  [[nodiscard]] Collocation& equations() { return _points.equations(); }
  [[nodiscard]] const TracePoint& last_point() const { return frontier.trace.points.back(); }

  std::optional<Orbit> first_orbit() override {
    const auto direction = start_direction();
    double amplitude = options.start_amplitude;
    int cells = cell_counts::at_least_for_cutoff(
        _points.domain(), std::min(std::max(start.base.cutoff, options.cutoff_from), options.cutoff_to));
    while (cells > 8 && _points.cutoff_of(cells) > options.cutoff_to) cells = cell_counts::previous(cells);
    _points.set_grid(cells, start.base.time_map);
    while (true) {
      Collocation& e = equations();
      frontier.amplitude = amplitude;
      TracePoint base{std::vector<double>(static_cast<std::size_t>(e.size()), 0.0), 0.0};
      e.from_loop(start.base, base.values.data());
      Prediction prediction = along(direction, base.values, amplitude);
      const std::vector<double> weights = _points.conditions_at(prediction);
      Trial trial = _points.correct(prediction, weights);
      if (trial.converged && !_points.resolved(trial)) {
        cells = cell_counts::next(cells);
        if (_points.cutoff_of(cells) > options.cutoff_to)
          return end(EndReason::cutoff_limit, fmt::format("the first orbit needs more than K = {}", options.cutoff_to));
        _points.set_grid(cells, start.base.time_map);
        continue;
      }
      if (trial.accepted()) {
        state().points = {base};
        ending = beyond_limits(trial.values[static_cast<std::size_t>(e.period_at())], _points.energy());
        if (ending) return std::nullopt;
        const double length = e.distance(trial.values.data(), base.values.data());
        frontier.next_length = std::min(4.0 * length, options.largest_step);
        return accept(trial);
      }
      state().factor_point.clear();
      amplitude *= 0.5;
      if (amplitude < 1e-6 * options.start_amplitude)
        return end(EndReason::failure, fmt::format("no orbit near the start: {}", trial.why()));
    }
  }

  /// The start's direction as a loop of unit |dz(s = 0)| (or unit length where z(s = 0) does not move).
  [[nodiscard]] loop::Loop start_direction() const {
    loop::Loop direction = loop::perturbation(start.base, start.direction);
    double square = 0.0;
    for (const double v : loop::state_at(direction, 0.0)) square += v * v;
    double length = 0.0;
    for (const double v : start.direction.modes) length += v * v;
    const double unit = square > 1e-16 * length ? std::sqrt(square) : std::sqrt(length);
    for (double& v : direction.modes) v /= unit;
    return direction;
  }

  [[nodiscard]] Prediction along(const loop::Loop& direction, const std::vector<double>& base, double amplitude) {
    Collocation& e = equations();
    Prediction out;
    out.order = 1;
    out.values = base;
    out.tangent.assign(base.size(), 0.0);
    loop::Loop relative = direction;
    for (std::size_t i = 0; i < e.centre().size(); ++i) relative.modes[i] += e.centre()[i];
    e.from_loop(relative, out.tangent.data());
    for (int q = 0; q < e.borders(); ++q) out.tangent[static_cast<std::size_t>(e.period_at() + q)] = 0.0;
    for (std::size_t n = 0; n < base.size(); ++n) out.values[n] += amplitude * out.tangent[n];
    return out;
  }

  void forget() override { _points.forget_grid(); }

  std::optional<Orbit> next_orbit(double at_most) override {
    const double amplitude = frontier.amplitude;
    const double least = std::min(options.smallest_step * (1.0 + amplitude) * std::min(1.0, amplitude), 0.1 * at_most);
    double length = std::min(std::max(length_to_try(), least), at_most);
    std::optional<Prediction> tangent;  // of length 1 from the last orbit, where it is needed
    for (int halved = 0;; ++halved) {
      // A polynomial through a sharp turn may point backwards, however short the step.
      if (halved >= 3 && !tangent) tangent = along_tangent();
      Trial trial = tangent ? correct(scaled(*tangent, length)) : try_step(length);
      const double wanted = options.prediction_error * std::min(1.0, amplitude);
      const bool jumped =
          trial.prediction_error > 100.0 * wanted ||
          (trial.converged && (_points.inverted(trial, last_point().values) || turned_too_far(trial, length, tangent)));
      if (trial.converged && !jumped && !_points.resolved(trial)) {
        if (!refine(trial))
          return end(EndReason::cutoff_limit, fmt::format("the next orbit needs more than K = {}", options.cutoff_to));
        --halved;
        tangent.reset();  // on the grid before
        continue;
      }
      if (trial.accepted() && !jumped) {
        const double ratio = wanted / std::max(trial.prediction_error, 1e-16);
        const double factor = std::clamp(std::pow(ratio, 1.0 / (trial.order + 1)), 0.3, 1.6);
        frontier.next_length = std::min(length * factor, options.largest_step);
        return accept_within_limits(std::move(trial), length);
      }
      state().factor_point.clear();
      length *= 0.5;
      if (!(length >= least))
        return end(EndReason::failure,
                   fmt::format("the corrector fails at T = {:.6g} even with step {:.1e}: {}", here().period, length,
                               jumped ? "it leaves the family" : trial.why()));
    }
  }

  [[nodiscard]] double length_to_try() {
    if (!options.fixed_step) return std::min(frontier.next_length, options.largest_step);
    // Where z(s = 0) hardly moves (a fold of it, a divergence) the step in loop space is bounded all the same.
    Collocation& e = equations();
    const Prediction here_and_on = extrapolate(state().points, options.predictor_order, last_point().parameter);
    std::vector<double> z(static_cast<std::size_t>(e.dimension() * e.grid().stride()));
    std::vector<double> slope(z.size());
    e.grid().at_nodes(here_and_on.tangent.data(), z.data(), slope.data());
    double square = 0.0;
    for (int i = 0; i < e.dimension(); ++i) square += std::pow(z[static_cast<std::size_t>(i * e.grid().stride())], 2);
    return std::min(*options.fixed_step / std::max(std::sqrt(square), 1e-12), 5.0 * options.largest_step);
  }

  Trial try_step(double length) {
    return correct(extrapolate(state().points, options.predictor_order, last_point().parameter + length));
  }

  Trial correct(Prediction prediction) {
    // A factor that has grown stale costs more iterations than a new one.
    if (frontier.orbit.iterations > renew_after) state().factor_point.clear();
    if (equations().borders() > 1) prediction.values[static_cast<std::size_t>(equations().period_at() + 1)] = 0.0;
    _points.hold_phase(prediction, last_point().values);
    const std::vector<double> weights = _points.conditions_at(prediction);
    return _points.correct(std::move(prediction), weights);
  }

  /// The family's own direction at the last orbit, on the side of the step that led there, as a step of length 1.
  [[nodiscard]] Prediction along_tangent() {
    const Prediction chord = extrapolate(state().points, 1, last_point().parameter);
    Prediction out{last_point().values, direction_here(chord), 1};
    for (std::size_t n = 0; n < out.values.size(); ++n) out.values[n] += out.tangent[n];
    const std::vector<double>& last = last_point().values;
    const double length = std::sqrt(_points.product(out.values, last, out.values, last));
    for (double& v : out.tangent) v /= length;
    return scaled(out, 1.0);
  }

  [[nodiscard]] Prediction scaled(Prediction step, double length) const {
    step.values = last_point().values;
    for (std::size_t n = 0; n < step.values.size(); ++n) step.values[n] += length * step.tangent[n];
    return step;
  }

  /// True if the step has left its prediction by more than 60 degrees, or turns by as much from the last step and from
  /// the family's direction (the last step may have gone around a bend): a bend that is not resolved, or the way back.
  [[nodiscard]] bool turned_too_far(const Trial& trial, double length, std::optional<Prediction>& tangent) {
    const std::vector<double>& last = last_point().values;
    const std::vector<double>& before = state().points[state().points.size() - 2].values;
    const double step = std::sqrt(_points.product(trial.values, last, trial.values, last));
    if (step > 2.0 * length) return true;
    const auto turned = [&](const std::vector<double>& from, const std::vector<double>& to) {
      return _points.product(trial.values, last, to, from) <
             0.5 * step * std::sqrt(_points.product(to, from, to, from));
    };
    if (!turned(before, last)) return false;
    if (!tangent) tangent = along_tangent();
    return turned(last, tangent->values);
  }

  /// More harmonics for the orbit just found; false where the scene does not allow them.
  bool refine(const Trial& trial) {
    const std::optional<Resolution> wanted = _points.finer(trial);
    if (wanted) _points.regrid(*wanted);
    return wanted.has_value();
  }

  std::optional<Orbit> accept_within_limits(Trial trial, double length) {
    Collocation& e = equations();
    const double period = trial.values[static_cast<std::size_t>(e.period_at())];
    if (period > options.period_limit) return orbit_on_period_limit(trial, length);
    const double energy = _points.energy();
    if (energy > options.energy_to) return orbit_on_energy_limit(energy, length, options.energy_to);
    if (energy < options.energy_from) return orbit_on_energy_limit(energy, length, options.energy_from);
    return accept(trial);
  }

  /// The last orbit of a branch lies on the scene's limit, not beyond it.
  std::optional<Orbit> orbit_on_period_limit(const Trial& beyond, double length) {
    const auto at_period = static_cast<std::size_t>(equations().period_at());
    std::vector<TracePoint> points = state().points;
    points.push_back({beyond.values, last_point().parameter + length});
    double low = last_point().parameter;
    double high = points.back().parameter;
    Prediction prediction;
    for (int n = 0; n < 60 && high - low > 1e-14 * high; ++n) {
      const double middle = 0.5 * (low + high);
      prediction = extrapolate(points, options.predictor_order, middle);
      (prediction.values[at_period] > options.period_limit ? high : low) = middle;
    }
    prediction = extrapolate(points, options.predictor_order, low);
    prediction.values[at_period] = options.period_limit;
    while (true) {
      std::vector<double> weights = _points.conditions_at(prediction);
      std::fill_n(weights.begin(), equations().size(), 0.0);
      weights[static_cast<std::size_t>(equations().period_at())] = 1.0;
      state().factor_point.clear();
      Trial trial = _points.correct(prediction, weights);
      const bool resolved = trial.converged && _points.resolved(trial);
      if (!trial.converged || (resolved && !trial.accepted()))
        return end(EndReason::failure,
                   fmt::format("no orbit at the period limit T = {:.6g}: {}", options.period_limit, trial.why()));
      if (resolved) {
        trial.values[static_cast<std::size_t>(equations().period_at())] = options.period_limit;
        _points.modes().period = options.period_limit;
        return accept(trial);
      }
      const std::optional<Resolution> wanted = _points.finer(trial);
      if (!wanted)
        return end(EndReason::cutoff_limit, fmt::format("the orbit at T = {:.6g} needs more than K = {}",
                                                        options.period_limit, options.cutoff_to));
      const Collocation& from = equations();
      const Collocation to(*system, _points.domain(), from.centre(), from.winding(), wanted->cells, wanted->time_map);
      prediction.values = to.resampled(from, prediction.values);
      prediction.tangent = to.resampled(from, prediction.tangent);
      _points.regrid(*wanted);
    }
  }

  /// Bracketing by the Illinois rule along the branch, every trial corrected.
  std::optional<Orbit> orbit_on_energy_limit(double energy_beyond, double length, double wanted) {
    double low = 0.0;
    double low_value = frontier.orbit.energy - wanted;
    double high = length;
    double high_value = energy_beyond - wanted;
    Trial trial;
    bool found = false;
    for (int n = 0; n < 60 && (!found || std::abs(high_value) > 1e-13 * (1.0 + std::abs(wanted))); ++n) {
      const double middle = (low * high_value - high * low_value) / (high_value - low_value);
      trial = try_step(middle);
      found = trial.converged && _points.resolved(trial);
      if (trial.converged && !found) {
        if (!refine(trial))
          return end(EndReason::cutoff_limit, fmt::format("the next orbit needs more than K = {}", options.cutoff_to));
        continue;
      }
      if (!trial.accepted())
        return end(EndReason::failure, fmt::format("no orbit at the energy limit E = {:.6g}: {}", wanted, trial.why()));
      const double value = _points.energy() - wanted;
      if ((value > 0.0) != (high_value > 0.0)) {
        low = high;
        low_value = high_value;
      } else {
        low_value *= 0.5;
      }
      high = middle;
      high_value = value;
    }
    if (!found || std::abs(high_value) > 1e-10 * (1.0 + std::abs(wanted)))
      return end(EndReason::failure,
                 fmt::format("no orbit at the energy limit E = {:.6g}: the bracket ends {:.1e} beside it", wanted,
                             high_value));
    frontier.on_energy_limit = true;
    return accept(trial);
  }

  Orbit accept(Trial& trial) {
    Collocation& e = equations();
    Orbit orbit;
    orbit.energy = _points.energy();
    orbit.loop = std::move(_points.modes());
    orbit.action = e.action(trial.values.data());
    orbit.loss_rms = trial.quality.loss_rms;
    orbit.tail = loop::tail(orbit.loop);
    orbit.iterations = trial.iterations;
    keep(orbit, begun() ? e.distance(trial.values.data(), last_point().values.data()) : 0.0, trial.quality.amplitude);
    frontier.tangent = {};
    std::vector<TracePoint>& points = state().points;
    // The length that the step has come out with: a parameter of its own would drift from extrapolation to extrapolation.
    const std::vector<double>& before = last_point().values;
    const double length = std::sqrt(_points.product(trial.values, before, trial.values, before));
    points.push_back({std::move(trial.values), last_point().parameter + length});
    const auto kept = static_cast<std::size_t>(options.predictor_order) + 1;
    if (points.size() > kept) points.erase(points.begin());
    if (options.off_branch_spectrum) {
      complete_frontier();
      frontier.orbit.off_branch_eigenvalue = off_branch_eigenvalue(*system, here(), start.isotropy, frontier.tangent);
    }
    const Orbit accepted = frontier.orbit;
    coarsen(trial);
    return accepted;
  }

  /// Fewer cells where the orbit needs far fewer harmonics than it has, or would under another time map.
  void coarsen(const Trial& trial) {
    if (options.fit_time_map && frontier.orbit.step % refit_every == 0)
      if (const std::optional<Resolution> other = _points.remapped(trial)) return _points.regrid(*other);
    const std::optional<int> fewer =
        coarser_cells(here(), _points.domain(), _points.tail_limit(trial), options.cutoff_from);
    if (fewer && *fewer < state().cells) _points.regrid({*fewer, state().time_map});
  }

  /// The family's direction at the last orbit, on the side of the prediction's. With equations of its own, so that the
  /// course of the branch does not depend on who asks.
  [[nodiscard]] std::vector<double> direction_here(const Prediction& prediction) {
    const Collocation& own = equations();
    Collocation e(*system, _points.domain(), own.centre(), own.winding(), state().cells, state().time_map);
    e.set_conditions(_points.conditions_at(prediction), last_point().values);
    try {
      return equations::family_direction(e, last_point().values);
    } catch (const core::NumericalError&) {
      return prediction.tangent;  // next to a crossing the linear system is singular
    }
  }

  void complete_frontier() override {
    if (!begun() || !frontier.tangent.empty()) return;
    const Collocation& own = equations();
    std::vector<double> tangent =
        direction_here(extrapolate(state().points, options.predictor_order, last_point().parameter));
    const loop::StaggeredGrid* grid = &own.grid();
    if (!(state().time_map == here().time_map)) {  // after a regrid for an orbit that was not accepted
      const std::vector<double> no_winding(own.winding().size(), 0.0);
      const int cells = cell_counts::at_least_for_cutoff(_points.domain(), here().cutoff);
      const Collocation before(*system, _points.domain(), own.centre(), no_winding, cells, here().time_map);
      tangent = before.resampled(own, tangent);
      grid = &before.grid();
    }
    loop::Tangent& out = frontier.tangent;
    out.modes.resize((2 * static_cast<std::size_t>(grid->cutoff()) + 1) * static_cast<std::size_t>(own.dimension()));
    grid->to_modes(tangent.data(), out.modes.data());
    out = loop::with_cutoff(std::move(out), here().cutoff, here().dimension);
    out.scalars = {tangent[tangent.size() - static_cast<std::size_t>(own.borders())]};
    out.normalize();
  }

  PointCorrector _points;
};

}  // namespace

std::unique_ptr<Branch::Implementation> make_collocation_branch(std::shared_ptr<const systems::System> system,
                                                                const Start& start, const Options& options) {
  loop::FundamentalDomain domain = loop::fundamental_domain(start.isotropy, system->dimension());
  if (!domain.expresses(start.isotropy) || !Collocation::applies(*system, domain)) return nullptr;
  return std::make_unique<CollocationBranch>(std::move(system), start, options, std::move(domain));
}

}  // namespace orbweaver::continuation
