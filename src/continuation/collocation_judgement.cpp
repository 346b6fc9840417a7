#include "collocation_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "collocation_metric.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::continuation {

using equations::Collocation;

namespace {

/// The residual between the places where the equations ask, in parts of that at them, from which on it is truncation's,
/// and not the solver's or rounding's, which are alike at both. Truncation was seen at 900.
constexpr double shows_truncation = 10.0;
/// Of the loss of the loop that is stored, what its mean over the nodes shows at least: a third is missed beside a
/// collision.
constexpr double seen_by_nodes = 0.7;
/// Over the last quarter harmonics that truncation leaves fall by a hundred where they end below 1e-8 of the first:
/// what is more than this part of those before it is rounding, of which further ones have as much.
constexpr double fallen = 0.3;

bool falls_no_further(const loop::Loop& loop, double tail) {
  return tail > fallen * loop::tail(loop::with_cutoff(loop, loop.cutoff - loop.cutoff / 4));
}

double period_of(const Collocation& equations, const std::vector<double>& values) {
  return values[static_cast<std::size_t>(equations.period_at())];
}

}  // namespace

void judge(const Collocation& equations, const std::vector<double>& winding, const Options& options, Trial& trial) {
  const Collocation::Quality quality = equations.quality(trial.values.data());
  const double period = period_of(equations, trial.values);
  trial.loss_rms = quality.loss_rms;
  trial.asked_rms = quality.asked;
  trial.amplitude = quality.amplitude;
  trial.size = extent_of(winding, quality.size);
  double centre = 0.0;
  for (const double c : equations.centre()) centre += c * c;
  const double size = std::sqrt(centre);
  const double jacobian = equations.field_jacobian_rms();
  const double tolerance = options.corrector.tolerance;
  trial.threshold = corrector::acceptance_threshold(tolerance, quality.speed_rms, size, jacobian);
  trial.tolerance_met = corrector::tolerance_met(tolerance, trial.loss_rms, quality.speed_rms, size, jacobian);
  const double floor = rounding_floor(equations, quality, period);
  trial.unsolved = quality.asked > std::max(trial.threshold, floor) && equations.has_cells_to_fit();
  trial.to_rounding = quality.unasked < floor;
  trial.threshold_of_the_way =
      corrector::acceptance_threshold(std::min(tolerance, of_the_way), quality.speed_rms, size, jacobian);
  trial.is_beside_the_way = tolerance > of_the_way && quality.asked > std::max(trial.threshold_of_the_way, floor);
  if (!(period > 0.0)) {
    trial.converged = false;
    trial.reason = "the period is not positive";
  } else if (!std::isfinite(trial.loss_rms)) {
    trial.converged = false;
    trial.reason = not_finite_at(equations, trial.values, trial.values, beyond_numbers);
  } else if (trial.loss_rms < seen_by_nodes * trial.threshold) {
    trial.is_orbit = true;
  } else if (trial.loss_rms < floor) {
    trial.is_orbit = trial.at_rounding = true;  // unless truncation explains the loss: `is_resolved`
  } else {
    trial.truncated = quality.unasked > shows_truncation * quality.asked;
    trial.reason = fmt::format("sqrt(loss) = {:.3g} falls no further, wanted {:.3g}", trial.loss_rms, trial.threshold);
  }
  if (!trial.is_orbit || quality.speed_rms >= corrector::least_known_speed(size, jacobian)) return;
  trial.is_orbit = trial.at_rounding = false;
  trial.lost_in_rounding = true;
  trial.reason = corrector::lost_in_rounding_text(quality.speed_rms, size, jacobian);
}

/// The residual that truncation leaves is about 2 pi / T K tail: only where that explains a loss above its threshold
/// do more harmonics help. The tail sees nothing where the harmonics come in bands about the multiples of a fast
/// oscillation's, and K lies between two: there the residual between the cells' middles shows it.
bool is_resolved(const Collocation& equations, const Options& options, Trial& trial) {
  trial.loop = equations.to_loop(trial.values.data());
  const double last = loop::tail(trial.loop);
  // Beside a fast motion rounding is magnified in the harmonics near it, and the residual does not see them.
  if (trial.to_rounding && falls_no_further(trial.loop, last) && equations.has_cells_to_fit()) return true;
  if (last > tail_limit(trial.amplitude, trial.size, options) || trial.truncated) return false;
  // A tail of the size of the modes' own rounding says nothing of the resolution.
  if (last <= mode_rounding * trial.size) return true;
  const double truncation = 2.0 * std::numbers::pi / trial.loop.period * trial.loop.cutoff * last;
  return trial.loss_rms < trial.threshold || truncation < corrector::least_explained * trial.loss_rms;
}

bool holds_to_rounding(const Collocation& equations, const std::vector<double>& values) {
  const double period = period_of(equations, values);
  if (!(period > 0.0)) return false;
  const Collocation::Quality quality = equations.quality(values.data());
  return quality.asked < rounding_floor(equations, quality, period);
}

std::string not_finite_at(const Collocation& equations, const std::vector<double>& values,
                          const std::vector<double>& predicted, const std::string& otherwise) {
  const auto period_at = static_cast<std::size_t>(equations.period_at());
  for (const std::vector<double>* point : {&predicted, &values}) {
    std::vector<double> there = *point;
    // The field does not depend on T, which a correction that fails may have taken below 0.
    double& period = there[period_at];
    if (!(period > 0.0) || !std::isfinite(period)) period = predicted[period_at];
    if (!std::all_of(there.begin(), there.end(), [](double v) { return std::isfinite(v); })) continue;
    try {
      equations.check_field(there.data());
    } catch (const core::NotFiniteError& error) {
      return error.what();
    }
  }
  return otherwise;
}

}  // namespace orbweaver::continuation
