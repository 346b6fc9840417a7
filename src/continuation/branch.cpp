#include "orbweaver/continuation/branch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "attempt.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log_stage.hpp"
#include "step_control.hpp"

namespace orbweaver::continuation {

namespace {

// True if the oscillation of one loop is the other's upside down: the step jumped across a fixed point, where the family
// ends (beyond it lie the same orbits half a period later).
bool inverted(const loop::Loop& from, const loop::Loop& to) {
  double product = 0.0;
  for (int k = 1; k <= std::min(from.cutoff, to.cutoff); ++k)
    for (int i = 0; i < from.dimension; ++i)
      product += from.cosine(k, i) * to.cosine(k, i) + from.sine(k, i) * to.sine(k, i);
  return product < 0.0;
}

}  // namespace

struct Branch::Implementation {
  std::shared_ptr<const systems::System> system;
  Start start;
  Options options;
  Frontier frontier{};
  std::optional<Ending> ending{};

  std::optional<Orbit> advance() {
    if (ending) return std::nullopt;
    return begun() ? next_orbit() : first_orbit();
  }

  [[nodiscard]] bool begun() const { return !here().modes.empty(); }
  [[nodiscard]] const loop::Loop& here() const { return frontier.orbit.loop; }
  [[nodiscard]] Direction tangent() const { return {frontier.tangent_modes, frontier.tangent_period}; }

  Attempt correct(const loop::Loop& base, const Direction& direction, double length) const {
    return correct_along(*system, base, direction, length, start.isotropy, options.corrector);
  }

  std::optional<Orbit> end(EndReason reason, std::string detail) {
    if (reason == EndReason::cutoff_limit && period_diverges()) {
      detail = fmt::format("T = {:.6g}, E = {:.12g}; {}", here().period, frontier.orbit.energy, detail);
      reason = EndReason::period_divergence;
    }
    ending = Ending{reason, std::move(detail)};
    return std::nullopt;
  }

  // T has more than doubled, and over its last tenth the energy has moved by less than a thousandth of its range.
  [[nodiscard]] bool period_diverges() const {
    if (!begun() || here().period < 2.0 * frontier.first.period) return false;
    const double range = std::abs(frontier.orbit.energy - frontier.first_energy);
    return std::abs(frontier.orbit.energy - frontier.earlier_energy) < 1e-3 * range;
  }

  Orbit accept(const Attempt& attempt) {
    const loop::Loop& loop = attempt.result.loop;
    Orbit orbit;
    orbit.loop = loop;
    orbit.energy = energy_of(*system, loop);
    orbit.action = action_of(*system, loop);
    orbit.loss_rms = attempt.result.loss_rms;
    orbit.tail = loop::tail(loop);
    orbit.iterations = attempt.result.iterations;
    if (begun()) {
      frontier.last_increment = arclength_between(here(), loop);
      orbit.step = frontier.orbit.step + 1;
      orbit.arclength = frontier.orbit.arclength + frontier.last_increment;
      if (loop.period > 1.1 * frontier.earlier_period) {
        frontier.earlier_energy = frontier.orbit.energy;
        frontier.earlier_period = here().period;
      }
    } else {
      frontier.first = loop;
      frontier.first_energy = frontier.earlier_energy = orbit.energy;
      frontier.earlier_period = loop.period;
    }
    if (options.off_branch_spectrum)
      orbit.off_branch_eigenvalue =
          off_branch_eigenvalue(*system, loop, start.isotropy, attempt.tangent.modes, attempt.tangent.period);
    frontier.orbit = orbit;
    frontier.tangent_modes = attempt.tangent.modes;
    frontier.tangent_period = attempt.tangent.period;
    lower_cutoff();
    return orbit;
  }

  // Harmonics that would stay negligible under a smaller cutoff are dropped before the next step.
  void lower_cutoff() {
    const int smaller = loop::previous_cutoff(here().cutoff);
    if (smaller < options.cutoff_from || smaller >= here().cutoff) return;
    const loop::Loop shorter = loop::with_cutoff(here(), smaller);
    const double negligible = 0.01 * tail_limit(here(), options);
    if (loop::mean_distance(here(), shorter) < negligible && loop::tail(shorter) < negligible) resize(smaller);
  }

  void resize(int cutoff) {
    frontier.orbit.loop = loop::with_cutoff(here(), cutoff);
    frontier.tangent_modes = with_cutoff(tangent(), cutoff, here().dimension).modes;
  }

  std::optional<Orbit> first_orbit() {
    int cutoff =
        std::min(std::max(start.base.cutoff, loop::allowed_cutoff_at_least(options.cutoff_from)), options.cutoff_to);
    int raises = 0;
    double amplitude = options.start_amplitude;
    while (true) {
      const loop::Loop base = loop::with_cutoff(start.base, cutoff);
      const Direction direction = with_cutoff({start.direction, 0.0}, cutoff, base.dimension);
      const double change = state_change(base, direction);
      const double length =
          amplitude * direction.norm() / (change > 1e-8 * direction.norm() ? change : direction.norm());
      const Attempt attempt = correct(base, direction, length);
      if (should_raise(attempt.result, raises)) {
        cutoff = loop::next_cutoff(cutoff);
        if (cutoff > options.cutoff_to)
          return end(EndReason::cutoff_limit, fmt::format("the first orbit needs more than K = {}", options.cutoff_to));
      } else if (attempt.result.converged()) {
        frontier.next_length = length;
        return accept_first(attempt);
      } else {
        raises = 0;
        amplitude *= 0.5;
        if (amplitude < 1e-6 * options.start_amplitude)
          return end(EndReason::failure, fmt::format("no orbit near the start: {}", attempt.result.detail));
      }
    }
  }

  std::optional<Orbit> accept_first(const Attempt& attempt) {
    const double period = attempt.result.loop.period;
    const double energy = energy_of(*system, attempt.result.loop);
    if (period > options.period_limit)
      return end(EndReason::period_limit, fmt::format("begins beyond it, at T = {:.9g}", period));
    if (energy > options.energy_to || energy < options.energy_from)
      return end(EndReason::energy_limit, fmt::format("begins beyond it, at E = {:.9g}", energy));
    return accept(attempt);
  }

  [[nodiscard]] double length_to_try() const {
    if (!options.fixed_step) return std::min(frontier.next_length, options.largest_step);
    // Where z(s = 0) hardly moves (a fold of it, a divergence) the step in loop space is bounded all the same.
    const double length = *options.fixed_step * tangent().norm() / std::max(state_change(here(), tangent()), 1e-12);
    return std::min(length, 5.0 * options.largest_step);
  }

  std::optional<Orbit> next_orbit() {
    ending = end_at(frontier.orbit);
    if (ending) return std::nullopt;
    const double amplitude = loop::rms_amplitude(here());
    const double least = options.smallest_step * (1.0 + amplitude) * std::min(1.0, amplitude);
    double length = std::max(length_to_try(), least);
    int raises = 0;
    while (true) {
      const Attempt attempt = correct(here(), tangent(), length);
      if (should_raise(attempt.result, raises)) {
        const int cutoff = loop::next_cutoff(here().cutoff);
        if (cutoff > options.cutoff_to)
          return end(EndReason::cutoff_limit, fmt::format("the next orbit needs more than K = {}", options.cutoff_to));
        resize(cutoff);
        continue;
      }
      const bool turned_too_far = attempt.turning > 3.0 * options.turning_angle && length > 1e3 * least;
      if (attempt.result.converged() && !turned_too_far && !inverted(here(), attempt.result.loop)) {
        // The iterations of first-order methods say nothing of the step.
        const int iterations = corrector::is_second_order(options.corrector.method) ? attempt.result.iterations : 0;
        frontier.next_length = next_step_length(length, iterations, attempt.turning, options.turning_angle);
        return accept_within_limits(attempt, length);
      }
      raises = 0;
      length *= 0.5;
      if (length < least)
        return end(EndReason::failure,
                   fmt::format("the corrector fails at T = {:.6g} even with step {:.1e}: {}", here().period, length,
                               attempt.result.converged() ? "it leaves the family" : attempt.result.detail));
    }
  }

  // More harmonics, unless they were raised before at this length and the corrector still does not converge: then the step
  // is too long, whatever the tail looks like.
  [[nodiscard]] bool should_raise(const corrector::Result& result, int& raises) const {
    if (!needs_more_harmonics(result, options)) return false;
    if (!result.converged() && ++raises > 3) return false;
    return true;
  }

  // The last orbit of a branch lies on the scene's limit, not beyond it.
  std::optional<Orbit> accept_within_limits(const Attempt& attempt, double length) {
    if (attempt.result.loop.period > options.period_limit) return orbit_on_period_limit(attempt);
    const double energy = energy_of(*system, attempt.result.loop);
    if (energy > options.energy_to) return orbit_on_energy_limit(attempt, length, options.energy_to);
    if (energy < options.energy_from) return orbit_on_energy_limit(attempt, length, options.energy_from);
    return accept(attempt);
  }

  std::optional<Orbit> orbit_on_period_limit(const Attempt& beyond) {
    const double weight = (options.period_limit - here().period) / (beyond.result.loop.period - here().period);
    loop::Loop guess = here();
    for (std::size_t n = 0; n < guess.modes.size(); ++n)
      guess.modes[n] += weight * (beyond.result.loop.modes[n] - guess.modes[n]);
    Attempt attempt;
    attempt.result = orbit_at_period(*system, guess, start.isotropy, options.period_limit, options);
    if (!attempt.result.converged())
      return end(EndReason::failure, fmt::format("no orbit at the period limit T = {:.6g}: {}", options.period_limit,
                                                 attempt.result.detail));
    if (needs_more_harmonics(attempt.result, options))
      return end(EndReason::cutoff_limit, fmt::format("the orbit at T = {:.6g} needs more than K = {}",
                                                      options.period_limit, options.cutoff_to));
    attempt.tangent = tangent_of(attempt.result);
    return accept(attempt);
  }

  // The flat direction of a result as a direction in loop space, on the side of the one so far.
  [[nodiscard]] Direction tangent_of(const corrector::Result& result) const {
    const Direction before = with_cutoff(tangent(), result.loop.cutoff, here().dimension);
    if (!result.flat_direction) return before;
    const loss::Unknowns unknowns{loop::Subspace(result.loop.dimension, result.loop.cutoff, start.isotropy), true};
    Direction found{std::vector<double>(result.loop.modes.size(), 0.0), (*result.flat_direction)(unknowns.size() - 1)};
    unknowns.subspace.add_to(
        std::span<const double>(result.flat_direction->data(), static_cast<std::size_t>(unknowns.subspace.size())),
        found.modes);
    double side = found.period * before.period;
    for (std::size_t n = 0; n < found.modes.size(); ++n) side += found.modes[n] * before.modes[n];
    if (side >= 0.0) return found;
    for (double& v : found.modes) v = -v;
    found.period = -found.period;
    return found;
  }

  // Bracketing by the Illinois rule in the step length, every trial re-converged.
  std::optional<Orbit> orbit_on_energy_limit(const Attempt& beyond, double length, double wanted) {
    double low = 0.0;
    double low_value = frontier.orbit.energy - wanted;
    double high = length;
    double high_value = energy_of(*system, beyond.result.loop) - wanted;
    Attempt attempt = beyond;
    for (int n = 0; n < 60 && std::abs(high_value) > 1e-13 * (1.0 + std::abs(wanted)); ++n) {
      const double trial = (low * high_value - high * low_value) / (high_value - low_value);
      attempt = correct(here(), tangent(), trial);
      if (attempt.result.outcome == corrector::Outcome::under_resolved &&
          loop::next_cutoff(here().cutoff) <= options.cutoff_to) {
        resize(loop::next_cutoff(here().cutoff));
        continue;
      }
      if (!attempt.result.converged())
        return end(EndReason::failure,
                   fmt::format("no orbit at the energy limit E = {:.6g}: {}", wanted, attempt.result.detail));
      const double value = energy_of(*system, attempt.result.loop) - wanted;
      if ((value > 0.0) != (high_value > 0.0)) {
        low = high;
        low_value = high_value;
      } else {
        low_value *= 0.5;
      }
      high = trial;
      high_value = value;
    }
    if (std::abs(high_value) > 1e-10 * (1.0 + std::abs(wanted)))
      return end(EndReason::failure,
                 fmt::format("no orbit at the energy limit E = {:.6g}: the bracket ends {:.1e} beside it", wanted,
                             high_value));
    Orbit orbit = accept(attempt);
    frontier.on_energy_limit = true;
    return orbit;
  }

  [[nodiscard]] std::optional<Ending> end_at(const Orbit& orbit) const {
    if (frontier.on_energy_limit) return Ending{EndReason::energy_limit, fmt::format("E = {:.12g}", orbit.energy)};
    if (orbit.loop.period >= options.period_limit)
      return Ending{EndReason::period_limit, fmt::format("T = {:.12g}", orbit.loop.period)};
    if (orbit.step + 1 >= options.step_limit)
      return Ending{EndReason::step_limit, fmt::format("{} orbits", orbit.step + 1)};
    if (orbit.step <= 3) return std::nullopt;
    const double amplitude = loop::rms_amplitude(orbit.loop);
    if (amplitude < 0.5 * std::min(loop::rms_amplitude(frontier.first), options.start_amplitude))
      return Ending{EndReason::fixed_point, fmt::format("T = {:.9g}, amplitude {:.2e}", orbit.loop.period, amplitude)};
    if (arclength_between(frontier.first, orbit.loop) < 0.5 * frontier.last_increment)
      return Ending{EndReason::closed_loop,
                    fmt::format("T = {:.9g}, length {:.6g}", orbit.loop.period, orbit.arclength)};
    return std::nullopt;
  }
};

Branch::Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options) {
  loop::validate(start.base);
  core::require(start.direction.size() == start.base.modes.size(),
                "a start's direction needs the size of its base loop's modes");
  core::require(std::any_of(start.direction.begin(), start.direction.end(), [](double v) { return v != 0.0; }),
                "a start's direction must not be zero");
  _implementation = std::make_unique<Implementation>(Implementation{std::move(system), start, std::move(options)});
}

Branch::~Branch() = default;
Branch::Branch(Branch&&) noexcept = default;
Branch& Branch::operator=(Branch&&) noexcept = default;

std::optional<Orbit> Branch::advance() {
  const core::LogStage stage(core::Stage::continuation);
  return _implementation->advance();
}
const std::optional<Ending>& Branch::ending() const { return _implementation->ending; }
const Frontier& Branch::frontier() const { return _implementation->frontier; }

Ending trace(std::shared_ptr<const systems::System> system, const Start& start, const Options& options,
             const Observer& observer) {
  Branch branch(std::move(system), start, options);
  while (const std::optional<Orbit> orbit = branch.advance())
    if (!observer(*orbit)) return {EndReason::stopped, fmt::format("T = {:.9g}", orbit->loop.period)};
  return branch.ending().value();
}

corrector::Result orbit_at_period(const systems::System& system, const loop::Loop& near, const loop::Isotropy& isotropy,
                                  double period, const Options& options) {
  loop::Loop guess = near;
  guess.period = period;
  while (true) {
    const loss::Unknowns unknowns{loop::Subspace(guess.dimension, guess.cutoff, isotropy), true};
    const Eigen::VectorXd pinned = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
    corrector::Result result = corrector::correct(system, guess, unknowns,
                                                  loss::Slice(unknowns.size(), conditions_at(guess, unknowns, pinned)),
                                                  options.corrector, pinned);
    const int larger = loop::next_cutoff(guess.cutoff);
    if (!needs_more_harmonics(result, options) || larger > options.cutoff_to) return result;
    guess = loop::with_cutoff(guess, larger);
  }
}

}  // namespace orbweaver::continuation
