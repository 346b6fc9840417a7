#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "attempt.hpp"
#include "branch_implementation.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
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

struct LoopBranch final : Branch::Implementation {
  using Implementation::Implementation;

  Attempt correct(const loop::Loop& base, const loop::Tangent& direction, double length) const {
    return correct_along(*system, base, direction, length, start.isotropy, options.corrector);
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
    keep(orbit, begun() ? arclength_between(here(), loop) : 0.0, loop::rms_amplitude(loop));
    if (options.off_branch_spectrum)
      frontier.orbit.off_branch_eigenvalue = off_branch_eigenvalue(*system, loop, start.isotropy, attempt.tangent);
    frontier.tangent = attempt.tangent;
    const Orbit accepted = frontier.orbit;
    lower_cutoff();
    return accepted;
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
    frontier.tangent = loop::with_cutoff(std::move(frontier.tangent), cutoff, here().dimension);
  }

  std::optional<Orbit> first_orbit() override {
    int cutoff =
        std::min(std::max(start.base.cutoff, loop::allowed_cutoff_at_least(options.cutoff_from)), options.cutoff_to);
    int raises = 0;
    double amplitude = options.start_amplitude;
    while (true) {
      const loop::Loop base = loop::with_cutoff(start.base, cutoff);
      const loop::Tangent direction = loop::with_cutoff(start.direction, cutoff, base.dimension);
      const double change = loop::change_at_start(base, direction);
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
    ending = beyond_limits(attempt.result.loop.period, energy_of(*system, attempt.result.loop));
    if (ending) return std::nullopt;
    return accept(attempt);
  }

  [[nodiscard]] double length_to_try() const {
    if (!options.fixed_step) return std::min(frontier.next_length, options.largest_step);
    // Where z(s = 0) hardly moves (a fold of it, a divergence) the step in loop space is bounded all the same.
    const double length = *options.fixed_step * frontier.tangent.norm() /
                          std::max(loop::change_at_start(here(), frontier.tangent), 1e-12);
    return std::min(length, 5.0 * options.largest_step);
  }

  std::optional<Orbit> next_orbit(double at_most) override {
    const double amplitude = loop::rms_amplitude(here());
    const double least = std::min(options.smallest_step * (1.0 + amplitude) * std::min(1.0, amplitude), 0.1 * at_most);
    double length = std::min(std::max(length_to_try(), least), at_most);
    int raises = 0;
    while (true) {
      const Attempt attempt = correct(here(), frontier.tangent, length);
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
  [[nodiscard]] loop::Tangent tangent_of(const corrector::Result& result) const {
    loop::Tangent before = loop::with_cutoff(frontier.tangent, result.loop.cutoff, here().dimension);
    if (!result.flat_direction) return before;
    const loss::Unknowns unknowns{loop::Subspace(result.loop.dimension, result.loop.cutoff, start.isotropy),
                                  {loss::Scalar::period()}};
    loop::Tangent found =
        unknowns.tangent_of({result.flat_direction->data(), static_cast<std::size_t>(result.flat_direction->size())});
    if (!(loop::dot(found, before) >= 0.0)) found *= -1.0;
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
      attempt = correct(here(), frontier.tangent, trial);
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
};

}  // namespace

std::unique_ptr<Branch::Implementation> make_loop_branch(std::shared_ptr<const systems::System> system,
                                                         const Start& start, const Options& options) {
  return std::make_unique<LoopBranch>(std::move(system), start, options);
}

}  // namespace orbweaver::continuation
